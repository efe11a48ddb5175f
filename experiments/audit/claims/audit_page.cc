#include "experiments/audit/claims/audit_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/audit/claims/audit_words.h"
#include "experiments/core/table/render_table.h"

namespace rcme {
namespace {

// The coverage by fifths of difficulty; names the worst one.
std::string FifthsAsMarkdown(const Claim& claim, const ClaimResult& result) {
  std::string text;
  for (size_t c = 0; c < claim.checks.size(); ++c) {
    const std::vector<DifficultyFifth>& fifths = result.checks[c].fifths;
    if (fifths.empty()) continue;
    Table table{{Column::Text("fifth"), Column::Text("bound (deg)"),
                 Column::Estimated("measured", kFourDigits), Column::Count("n")}};
    const auto worst = std::ranges::min_element(fifths, {}, &DifficultyFifth::measured);
    for (auto fifth = fifths.begin(); fifth != fifths.end(); ++fifth) {
      table.rows.push_back({fmt::format("{}{}", fifth - fifths.begin() + 1, fifth == worst ? " (worst)" : ""),
                            fmt::format("{:.3g} to {:.3g}", fifth->easiest, fifth->hardest),
                            Estimate{fifth->measured, fifth->interval}, fifth->n});
    }
    text += fmt::format("\n{}, {}, by the Cramer-Rao bound of the problem (root of the trace):\n\n{}",
                        DescribeConditions(claim.checks[c]), claim.checks[c].targets.front().quantity,
                        RenderMarkdown(table));
  }
  return text;
}

// What would decide an undecided target; empty for others.
std::string DescribeRemedy(const TargetResult& target) {
  if (target.verdict != Verdict::kUndecided) return "";
  return std::isfinite(target.trials_to_decide)
             ? fmt::format(" (about {:.2g} trials would do)", target.trials_to_decide)
             : " (no number of trials may do)";
}

Table MakeEvidenceTable(const Audit& audit, const Claim& claim, const ClaimResult& result) {
  Table table{{Column::Text("conditions"), Column::Text("quantity"), Column::Text("claimed"),
               Column::Text("found with p = 0.9"), Column::Estimated("measured", kFourDigits),
               Column::Text("n"), Column::Text("verdict")}};
  for (size_t c = 0; c < claim.checks.size(); ++c) {
    const Check& check = claim.checks[c];
    const CheckResult& of = result.checks[c];
    if (!of.not_possible.empty()) {
      table.rows.push_back(
          {DescribeConditions(check), {}, {}, {}, {}, "0", "not possible: " + of.not_possible});
    }
    for (size_t t = 0; t < of.targets.size(); ++t) {
      const TargetResult& target = of.targets[t];
      if (IsLeftOut(check.targets[t], target)) continue;
      table.rows.push_back({DescribeConditions(check), check.targets[t].quantity,
                            DescribeClaimed(check.targets[t]), DescribePower(audit, check, check.targets[t]),
                            Estimate{target.measured, target.interval}, DescribeTrials(target, of),
                            AddSide(VerdictName(target.verdict), FindFailedSide(check.targets[t], target)) +
                                DescribeRemedy(target)});
    }
  }
  return table;
}

std::string ClaimAsMarkdown(const Audit& audit, const Claim& claim, const ClaimResult& result) {
  return fmt::format("### {} ({})\n\n{}: \"{}.\" Measured: {}.\n\n**{}**\n\n", claim.id, claim.reading,
                     claim.label, claim.sentence, claim.statistic, DescribeVerdict(claim, result)) +
         RenderMarkdown(MakeEvidenceTable(audit, claim, result)) + FifthsAsMarkdown(claim, result) + "\n";
}

// The verdicts of the claims, and beside them those of a study's conditions if they fit on a page.
Table MakeVerdictTable(const Audit& audit) {
  constexpr size_t kMostColumns = 8;
  size_t num_columns = 0;
  for (const Claim& claim : audit.claims) {
    if (IsOnStudy(audit)) num_columns = std::max(num_columns, claim.checks.size());
  }
  if (num_columns == 1 || num_columns > kMostColumns) num_columns = 0;
  Table table{{Column::Text("claim"), Column::Text("reading"), Column::Text("verdict")}};
  for (size_t c = 0; c < num_columns; ++c)
    table.columns.push_back(Column::Text(DescribeConditions(audit.claims.front().checks[c])));
  for (size_t i = 0; i < audit.claims.size(); ++i) {
    const Claim& claim = audit.claims[i];
    std::vector<Value>& row = table.rows.emplace_back();
    row = {claim.id, claim.reading, DescribeVerdict(claim, audit.results[i])};
    for (size_t c = 0; c < num_columns; ++c)
      row.emplace_back(DescribeVerdict(claim.checks[c], audit.results[i].checks[c]));
  }
  return table;
}

}  // namespace

std::string AuditAsMarkdown(const Audit& audit) {
  std::string text = fmt::format("# Claim audit{}\n\nSeed {}, budget {}. {}\n\n{}",
                                 IsOnStudy(audit) ? " on study " + audit.options.study : "",
                                 audit.options.seed, BudgetName(audit.options.budget), DescribeErrors(audit),
                                 RenderMarkdown(MakeVerdictTable(audit)));
  std::string family;
  for (size_t i = 0; i < audit.claims.size(); ++i) {
    const Claim& claim = audit.claims[i];
    if (claim.family() != family) {
      family = claim.family();
      text += fmt::format("\n## {0}\n\n![{0}](audit_{0}.png)\n\n", family);
    }
    text += ClaimAsMarkdown(audit, claim, audit.results[i]);
  }
  return text;
}

}  // namespace rcme
