#include "experiments/audit/claims/audit_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/audit/claims/power.h"
#include "experiments/core/table/render_table.h"
#include "experiments/core/text/field_text.h"
#include "experiments/core/text/json_output.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

const char* BudgetName(Budget budget) { return budget == Budget::kQuick ? "quick" : "full"; }

const char* VerdictName(const std::optional<Verdict>& verdict) {
  return verdict ? Name(*verdict) : Name(ClaimVerdict::kMeasured);
}

std::string DescribeConditions(const Check& check) {
  std::string words;
  for (const auto& [key, value] : check.conditions) {
    words += fmt::format("{}{} = {}", words.empty() ? "" : ", ", key, value);
  }
  return words;
}

const NumberFormat kFourDigits{1.0, "", ".4g"};

Estimate MakeEstimate(const TargetResult& result) { return {result.measured, result.interval}; }

std::string DescribeClaimed(const Target& target) {
  if (!target.IsClaimed()) return "-";
  return fmt::format("{:.4g} in [{:.4g}, {:.4g}]", target.nominal, target.allowed.lower,
                     target.allowed.upper);
}

// What the target can decide at the audit's budget; "-" where nothing is claimed.
std::string DescribePower(const Audit& audit, const Check& check, const Target& target) {
  if (!target.IsClaimed()) return "-";
  return DescribeFound(FindPower(target, check.limits.Max(audit.options.budget), audit.confidence));
}

// How the regions of a check or a claim are wrong.
std::optional<Side> FindSide(const Check& check, const CheckResult& result) {
  std::vector<std::optional<Side>> sides;
  for (size_t t = 0; t < result.targets.size(); ++t)
    sides.push_back(FindFailedSide(check.targets[t], result.targets[t]));
  return JoinSides(sides);
}

std::optional<Side> FindSide(const Claim& claim, const ClaimResult& result) {
  std::vector<std::optional<Side>> sides;
  for (size_t c = 0; c < claim.checks.size(); ++c)
    sides.push_back(FindSide(claim.checks[c], result.checks[c]));
  return JoinSides(sides);
}

// Empty: none.
std::string SideName(const std::optional<Side>& side) { return side ? Name(*side) : ""; }

// "does not hold: too narrow"
std::string AddSide(const std::string& verdict, const std::optional<Side>& side) {
  return side ? fmt::format("{}: {}", verdict, Name(*side)) : verdict;
}

std::string DescribeVerdict(const Claim& claim, const ClaimResult& result) {
  std::string words = Name(result.verdict);
  if (result.verdict == ClaimVerdict::kSmallNoiseOnly) {
    return fmt::format("{} (up to {} px)", words, *result.holds_up_to_sigma_px);
  }
  if (result.verdict == ClaimVerdict::kDoesNotHold) words = AddSide(words, FindSide(claim, result));
  const auto num_impossible = std::ranges::count_if(
      result.checks, [](const CheckResult& check) { return !check.not_possible.empty(); });
  if (num_impossible == 0 || result.verdict == ClaimVerdict::kNotPossible) return words;
  return fmt::format("{} (not possible in {} of {} conditions)", words, num_impossible, claim.checks.size());
}

std::string DescribeVerdict(const Check& check, const CheckResult& result) {
  if (!result.not_possible.empty()) return Name(ClaimVerdict::kNotPossible);
  return AddSide(VerdictName(result.verdict), FindSide(check, result));
}

// A target of which no answer states anything is left out.
bool IsLeftOut(const Target& target, const TargetResult& result) {
  return target.is_if_stated && result.n == 0;
}

// The target that decided the checks [begin, end) of a claim: of the check at the asserted noise level (or
// the nearest below), the first that does not hold, else the first undecided, else the first. Null: none of
// them has a target.
struct Decisive {
  const Check* check;
  const Target* target;
  const TargetResult* result;
};

Decisive FindDecisive(const Claim& claim, const ClaimResult& result, size_t begin, size_t end) {
  const auto distance = [](const Check& check) {
    const double excess = check.sigma_px.value_or(kAssertedSigmaPx) - kAssertedSigmaPx;
    return excess > 0.0 ? 1e3 + excess : -excess;
  };
  const auto severity = [](const std::optional<Verdict>& verdict) {
    return !verdict ? 0 : *verdict == Verdict::kHolds ? 1 : *verdict == Verdict::kUndecided ? 2 : 3;
  };
  Decisive best{nullptr, nullptr, nullptr};
  for (size_t c = begin; c < end; ++c) {
    for (size_t t = 0; t < result.checks[c].targets.size(); ++t) {
      const Decisive candidate{&claim.checks[c], &claim.checks[c].targets[t], &result.checks[c].targets[t]};
      const bool is_nearer = !best.check || distance(*candidate.check) < distance(*best.check);
      const bool is_as_near = best.check && distance(*candidate.check) == distance(*best.check);
      if (is_nearer || (is_as_near && severity(candidate.result->verdict) > severity(best.result->verdict))) {
        best = candidate;
      }
    }
  }
  return best;
}

Json PowerAsJson(const TargetPower& power) {
  return {{"holds_at_nominal", JsonNumber(power.holds_at_nominal)},
          {"found_outside", {JsonNumber(power.found.lower), JsonNumber(power.found.upper)}},
          {"found_sigma_error_outside",
           {JsonNumber(power.found_sigma.lower), JsonNumber(power.found_sigma.upper)}}};
}

Json TargetAsJson(const Target& target, const TargetResult& result) {
  const char* kind = target.IsMean() ? "mean" : "rate";
  Json json = {{"quantity", target.quantity},
               {"kind", kind},
               {"nominal", JsonNumber(target.nominal)},
               {"low", JsonNumber(target.allowed.lower)},
               {"high", JsonNumber(target.allowed.upper)},
               {"threshold", JsonNumber(target.threshold)},
               {"measured", JsonNumber(result.measured)},
               {"interval", {JsonNumber(result.interval.lower), JsonNumber(result.interval.upper)}},
               {"n", result.n},
               {"verdict", VerdictName(result.verdict)},
               {"side", SideName(FindFailedSide(target, result))}};
  json["trials_to_decide"] =
      result.verdict == Verdict::kUndecided ? JsonNumber(result.trials_to_decide) : Json();
  return json;
}

Json FifthsAsJson(const std::vector<DifficultyFifth>& fifths) {
  Json json = Json::array();
  for (const DifficultyFifth& fifth : fifths) {
    json.push_back({{"bound_deg", {JsonNumber(fifth.easiest), JsonNumber(fifth.hardest)}},
                    {"measured", JsonNumber(fifth.measured)},
                    {"interval", {fifth.interval.lower, fifth.interval.upper}},
                    {"n", fifth.n}});
  }
  return json;
}

Json CheckAsJson(const Audit& audit, const Check& check, const CheckResult& result) {
  Json json = {{"conditions", Json::object()},           {"num_trials", result.num_trials},
               {"verdict", VerdictName(result.verdict)}, {"side", SideName(FindSide(check, result))},
               {"not_possible", result.not_possible},    {"targets", Json::array()}};
  if (check.sigma_px) json["conditions"]["sigma_px"] = fmt::format("{}", *check.sigma_px);
  for (const auto& [key, value] : check.conditions) json["conditions"][key] = value;
  for (size_t t = 0; t < result.targets.size(); ++t) {
    if (IsLeftOut(check.targets[t], result.targets[t])) continue;
    json["targets"].push_back(TargetAsJson(check.targets[t], result.targets[t]));
    if (!check.targets[t].IsClaimed()) continue;
    json["targets"].back()["power"] =
        PowerAsJson(FindPower(check.targets[t], check.limits.Max(audit.options.budget), audit.confidence));
  }
  if (!result.fifths.empty()) json["fifths_of_difficulty"] = FifthsAsJson(result.fifths);
  return json;
}

Json ClaimAsJson(const Audit& audit, const Claim& claim, const ClaimResult& result) {
  Json json = {
      {"id", claim.id},
      {"family", claim.family()},
      {"label", claim.label},
      {"reading", claim.reading},
      {"sentence", claim.sentence},
      {"statistic", claim.statistic},
      {"verdict", Name(result.verdict)},
      {"side", result.verdict == ClaimVerdict::kDoesNotHold ? SideName(FindSide(claim, result)) : ""}};
  json["holds_up_to_sigma_px"] = result.holds_up_to_sigma_px ? Json(*result.holds_up_to_sigma_px) : Json();
  json["holds_at_nominal"] = HoldsAtNominal(claim, audit.options.budget, audit.confidence);
  json["figure_x"] = claim.figure_x;
  json["evidence"] = Json::array();
  for (size_t c = 0; c < claim.checks.size(); ++c) {
    json["evidence"].push_back(CheckAsJson(audit, claim.checks[c], result.checks[c]));
  }
  return json;
}

// n, and of how many trials where not all of them say something of the target.
std::string DescribeTrials(const TargetResult& target, const CheckResult& check) {
  return target.n == check.num_trials ? fmt::format("{}", target.n)
                                      : fmt::format("{} of {}", target.n, check.num_trials);
}

// The coverage by fifths of difficulty, the worst one named.
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

// What would decide an undecided target; else nothing.
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
                            MakeEstimate(target), DescribeTrials(target, of),
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

std::string ErrorStatement(const Audit& audit) {
  return fmt::format(
      "Intervals hold at all sample sizes at once, each with confidence 1 - {:.2g}; the probability of any "
      "false "
      "verdict among all {} claimed numbers is at most {}.",
      1.0 - audit.confidence, audit.num_targets, kAuditErrorRate);
}

bool IsOnStudy(const Audit& audit) { return !audit.options.study.empty(); }

// One row per claim and condition of a study, after one for all conditions where there are several.
Table MakeConditionTable(const Audit& audit) {
  Table table{{Column::Key("claim"), Column::Key("condition"), Column::Text("verdict"),
               Column::Text("quantity"), Column::Text("claimed"), Column::Estimated("measured", kFourDigits),
               Column::Text("n")}};
  for (size_t i = 0; i < audit.claims.size(); ++i) {
    const Claim& claim = audit.claims[i];
    const ClaimResult& result = audit.results[i];
    if (claim.checks.size() > 1) {
      table.rows.push_back(
          {claim.id, fmt::format("all {}", claim.checks.size()), DescribeVerdict(claim, result)});
    }
    for (size_t c = 0; c < claim.checks.size(); ++c) {
      const Decisive decisive = FindDecisive(claim, result, c, c + 1);
      table.rows.push_back({claim.id, DescribeConditions(claim.checks[c]),
                            DescribeVerdict(claim.checks[c], result.checks[c])});
      std::vector<Value>& row = table.rows.back();
      if (decisive.target) {
        row.insert(row.end(),
                   {decisive.target->quantity, DescribeClaimed(*decisive.target),
                    MakeEstimate(*decisive.result), DescribeTrials(*decisive.result, result.checks[c])});
      } else {
        row.emplace_back(result.checks[c].not_possible);
      }
    }
  }
  for (std::vector<Value>& row : table.rows) row.resize(table.columns.size());
  return table;
}

// One row per claim: the target that decided it.
Table MakeClaimTable(const Audit& audit) {
  Table table{{Column::Key("claim"), Column::Text("verdict"), Column::Text("quantity"),
               Column::Text("sigma_px"), Column::Text("claimed"), Column::Text("found (p = 0.9)"),
               Column::Estimated("measured", kFourDigits), Column::Count("n")}};
  for (size_t i = 0; i < audit.claims.size(); ++i) {
    const Claim& claim = audit.claims[i];
    const Decisive decisive = FindDecisive(claim, audit.results[i], 0, claim.checks.size());
    std::vector<Value>& row = table.rows.emplace_back();
    row = {claim.id, DescribeVerdict(claim, audit.results[i])};
    if (decisive.target) {
      row.insert(
          row.end(),
          {decisive.target->quantity, fmt::format("{}", decisive.check->sigma_px.value_or(kAssertedSigmaPx)),
           DescribeClaimed(*decisive.target), DescribePower(audit, *decisive.check, *decisive.target),
           MakeEstimate(*decisive.result), decisive.result->n});
    } else {
      row.emplace_back(audit.results[i].checks.front().not_possible);
    }
    row.resize(table.columns.size());
  }
  return table;
}

// The verdicts: of the claims, and beside them those of a study's conditions where they fit on a page.
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

// A row per claimed or measured number.
Table MakeNumberTable(const Audit& audit) {
  Table table{{Column::Key("claim"),
               Column::Text("family"),
               Column::Text("reading"),
               Column::Text("claim_verdict"),
               Column::Number("holds_up_to_sigma_px"),
               Column::Text("conditions"),
               Column::Text("quantity"),
               Column::Text("kind"),
               Column::Number("nominal"),
               Column::Number("low"),
               Column::Number("high"),
               Column::Number("value"),
               {"lower,upper", ColumnType::kInterval},
               Column::Count("n"),
               Column::Text("verdict"),
               Column::Text("side")}};
  for (size_t i = 0; i < audit.claims.size(); ++i) {
    const Claim& claim = audit.claims[i];
    const ClaimResult& result = audit.results[i];
    for (size_t c = 0; c < claim.checks.size(); ++c) {
      const Check& check = claim.checks[c];
      for (size_t t = 0; t < result.checks[c].targets.size(); ++t) {
        const Target& target = check.targets[t];
        const TargetResult& found = result.checks[c].targets[t];
        if (IsLeftOut(target, found)) continue;
        table.rows.push_back({claim.id, claim.family(), claim.reading, Name(result.verdict),
                              result.holds_up_to_sigma_px.value_or(std::nan("")), DescribeConditions(check),
                              target.quantity, target.IsMean() ? "mean" : "rate", target.nominal,
                              target.allowed.lower, target.allowed.upper, found.measured, found.interval,
                              found.n, VerdictName(found.verdict), SideName(FindFailedSide(target, found))});
      }
    }
  }
  return table;
}

Table MakePlanTable(const Audit& plan) {
  const Budget budget = plan.options.budget;
  Column holds_column = Column::Number("holds_at_nominal", {1.0, "", ".3f"}),
         found_column = Column::Text("found");
  holds_column.heading = "holds at nominal";
  found_column.heading = "found with p = 0.9";
  Table table{{Column::Key("claim"), Column::Key("quantity"), Column::Count("checks"), holds_column,
               Column::Text("claimed"), Column::Count("trials"), found_column}};
  for (const Claim& claim : plan.claims) {
    const Check& check = claim.checks.front();
    const double holds = HoldsAtNominal(claim, budget, plan.confidence);
    for (const Target& target : check.targets) {
      if (!target.IsClaimed()) continue;
      table.rows.push_back({claim.id, target.quantity, std::ssize(claim.checks), holds,
                            DescribeClaimed(target), check.limits.Max(budget),
                            DescribePower(plan, check, target)});
    }
  }
  return table;
}

}  // namespace

CommandResult MakePlanResult(const Audit& plan) {
  const std::string text =
      FormatParagraph(fmt::format("Seed {}, budget {}. {}", plan.options.seed,
                                  BudgetName(plan.options.budget), ErrorStatement(plan))) +
      "\n" + RenderText(MakePlanTable(plan));
  return MakeResult(text, kAuditPlanFormat,
                    {{"seed", static_cast<std::int64_t>(plan.options.seed)},
                     {"budget", BudgetName(plan.options.budget)},
                     {"confidence_per_target", plan.confidence}},
                    MakePlanTable(plan));
}

std::string AuditAsTable(const Audit& audit) {
  return RenderText(IsOnStudy(audit) ? MakeConditionTable(audit) : MakeClaimTable(audit)) + "\n" +
         FormatParagraph(ErrorStatement(audit));
}

std::string AuditAsJson(const Audit& audit) {
  Json json = {{"seed", audit.options.seed},
               {"budget", BudgetName(audit.options.budget)},
               {"confidence_per_target", audit.confidence},
               {"num_targets", audit.num_targets},
               {"study", audit.options.study}};
  for (const auto& [key, value] : audit.options.conditions) json["default_conditions"][key] = value;
  json["claims"] = Json::array();
  for (size_t i = 0; i < audit.claims.size(); ++i) {
    json["claims"].push_back(ClaimAsJson(audit, audit.claims[i], audit.results[i]));
  }
  json["rows"] = RenderJson(MakeNumberTable(audit));
  return JsonText(kAuditFormat, json);
}

std::string AuditAsMarkdown(const Audit& audit) {
  std::string text = fmt::format("# Claim audit{}\n\nSeed {}, budget {}. {}\n\n{}",
                                 IsOnStudy(audit) ? " on study " + audit.options.study : "",
                                 audit.options.seed, BudgetName(audit.options.budget), ErrorStatement(audit),
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

CommandResult MakeAuditResult(const Audit& audit) {
  return {AuditAsTable(audit), MakeNumberTable(audit), AuditAsJson(audit)};
}

}  // namespace rcme
