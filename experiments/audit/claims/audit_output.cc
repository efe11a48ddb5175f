#include "experiments/audit/claims/audit_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/core/text/columns.h"
#include "experiments/core/text/json_output.h"
#include "experiments/audit/claims/power.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

const char* BudgetName(Budget budget) { return budget == Budget::kQuick ? "quick" : "full"; }

const char* VerdictName(const std::optional<Verdict>& verdict) {
  return verdict ? Name(*verdict) : Name(ClaimVerdict::kMeasured);
}

Json Number(double x) { return std::isfinite(x) ? Json(x) : Json(); }

std::string ConditionsInWords(const Check& check) {
  std::string words;
  for (const auto& [key, value] : check.conditions) {
    words += fmt::format("{}{} = {}", words.empty() ? "" : ", ", key, value);
  }
  return words;
}

std::string MeasuredInWords(const TargetResult& result) {
  return fmt::format("{:.4g} [{:.4g}, {:.4g}]", result.measured, result.interval.lower,
                     result.interval.upper);
}

std::string ClaimedInWords(const Target& target) {
  if (!target.IsClaimed()) return "-";
  return fmt::format("{:.4g} in [{:.4g}, {:.4g}]", target.nominal, target.allowed.lower,
                     target.allowed.upper);
}

// What the target can decide at the audit's budget; "-" where nothing is claimed.
std::string PowerInWords(const Audit& audit, const Check& check, const Target& target) {
  if (!target.IsClaimed()) return "-";
  return FoundInWords(PowerOf(target, check.limits.Max(audit.options.budget), audit.confidence));
}

// How the regions of a check or a claim are wrong.
std::optional<Side> FindSide(const Check& check, const CheckResult& result) {
  std::vector<std::optional<Side>> sides;
  for (size_t t = 0; t < result.targets.size(); ++t)
    sides.push_back(SideOf(check.targets[t], result.targets[t]));
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

std::string VerdictInWords(const Claim& claim, const ClaimResult& result) {
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

std::string VerdictInWords(const Check& check, const CheckResult& result) {
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

Decisive DecisiveOf(const Claim& claim, const ClaimResult& result, size_t begin, size_t end) {
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
  return {{"holds_at_nominal", Number(power.holds_at_nominal)},
          {"found_outside", {Number(power.found.lower), Number(power.found.upper)}},
          {"found_sigma_error_outside", {Number(power.found_sigma.lower), Number(power.found_sigma.upper)}}};
}

Json TargetAsJson(const Target& target, const TargetResult& result) {
  const char* kind = target.IsMean() ? "mean" : "rate";
  Json json = {{"quantity", target.quantity},
               {"kind", kind},
               {"nominal", Number(target.nominal)},
               {"low", Number(target.allowed.lower)},
               {"high", Number(target.allowed.upper)},
               {"threshold", Number(target.threshold)},
               {"measured", Number(result.measured)},
               {"interval", {Number(result.interval.lower), Number(result.interval.upper)}},
               {"n", result.n},
               {"verdict", VerdictName(result.verdict)},
               {"side", SideName(SideOf(target, result))}};
  json["trials_to_decide"] = result.verdict == Verdict::kUndecided ? Number(result.trials_to_decide) : Json();
  return json;
}

Json FifthsAsJson(const std::vector<DifficultyFifth>& fifths) {
  Json json = Json::array();
  for (const DifficultyFifth& fifth : fifths) {
    json.push_back({{"bound_deg", {Number(fifth.easiest), Number(fifth.hardest)}},
                    {"measured", Number(fifth.measured)},
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
        PowerAsJson(PowerOf(check.targets[t], check.limits.Max(audit.options.budget), audit.confidence));
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
std::string TrialsInWords(const TargetResult& target, const CheckResult& check) {
  return target.n == check.num_trials ? fmt::format("{}", target.n)
                                      : fmt::format("{} of {}", target.n, check.num_trials);
}

// The coverage by fifths of difficulty, the worst one named.
std::string FifthsAsMarkdown(const Claim& claim, const ClaimResult& result) {
  std::string text;
  for (size_t c = 0; c < claim.checks.size(); ++c) {
    const std::vector<DifficultyFifth>& fifths = result.checks[c].fifths;
    if (fifths.empty()) continue;
    const auto worst = std::ranges::min_element(fifths, {}, &DifficultyFifth::measured);
    text += fmt::format(
        "\n{}, {}, by the Cramer-Rao bound of the problem (root of the trace):\n\n"
        "| fifth | bound (deg) | measured | n |\n|---|---|---|---|\n",
        ConditionsInWords(claim.checks[c]), claim.checks[c].targets.front().quantity);
    for (auto fifth = fifths.begin(); fifth != fifths.end(); ++fifth) {
      text += fmt::format("| {}{} | {:.3g} to {:.3g} | {:.4g} [{:.4g}, {:.4g}] | {} |\n",
                          fifth - fifths.begin() + 1, fifth == worst ? " (worst)" : "", fifth->easiest,
                          fifth->hardest, fifth->measured, fifth->interval.lower, fifth->interval.upper,
                          fifth->n);
    }
  }
  return text;
}

std::string ClaimAsMarkdown(const Audit& audit, const Claim& claim, const ClaimResult& result) {
  std::string text =
      fmt::format("### {} ({})\n\n{}: \"{}.\" Measured: {}.\n\n**{}**\n\n", claim.id, claim.reading,
                  claim.label, claim.sentence, claim.statistic, VerdictInWords(claim, result));
  text +=
      "| conditions | quantity | claimed | found with p = 0.9 | measured | n | verdict "
      "|\n|---|---|---|---|---|---|---|\n";
  for (size_t c = 0; c < claim.checks.size(); ++c) {
    if (!result.checks[c].not_possible.empty()) {
      text += fmt::format("| {} | | | | | 0 | not possible: {} |\n", ConditionsInWords(claim.checks[c]),
                          result.checks[c].not_possible);
    }
    for (size_t t = 0; t < result.checks[c].targets.size(); ++t) {
      const TargetResult& target = result.checks[c].targets[t];
      if (IsLeftOut(claim.checks[c].targets[t], target)) continue;
      std::string verdict = AddSide(VerdictName(target.verdict), SideOf(claim.checks[c].targets[t], target));
      if (target.verdict == Verdict::kUndecided) {
        verdict += std::isfinite(target.trials_to_decide)
                       ? fmt::format(" (about {:.2g} trials would do)", target.trials_to_decide)
                       : " (no number of trials may do)";
      }
      text += fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", ConditionsInWords(claim.checks[c]),
                          claim.checks[c].targets[t].quantity, ClaimedInWords(claim.checks[c].targets[t]),
                          PowerInWords(audit, claim.checks[c], claim.checks[c].targets[t]),
                          MeasuredInWords(target), TrialsInWords(target, result.checks[c]), verdict);
    }
  }
  return text + FifthsAsMarkdown(claim, result) + "\n";
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
std::vector<std::vector<std::string>> RowsPerCondition(const Audit& audit) {
  std::vector<std::vector<std::string>> rows = {
      {"claim", "condition", "verdict", "quantity", "claimed", "measured", "n"}};
  for (size_t i = 0; i < audit.claims.size(); ++i) {
    const Claim& claim = audit.claims[i];
    const ClaimResult& result = audit.results[i];
    if (claim.checks.size() > 1) {
      rows.push_back({claim.id, fmt::format("all {}", claim.checks.size()), VerdictInWords(claim, result), "",
                      "", "", ""});
    }
    for (size_t c = 0; c < claim.checks.size(); ++c) {
      const Decisive decisive = DecisiveOf(claim, result, c, c + 1);
      rows.push_back({claim.id, ConditionsInWords(claim.checks[c]),
                      VerdictInWords(claim.checks[c], result.checks[c]), result.checks[c].not_possible, "",
                      "", ""});
      if (!decisive.target) continue;
      rows.back()[3] = decisive.target->quantity;
      rows.back()[4] = ClaimedInWords(*decisive.target);
      rows.back()[5] = MeasuredInWords(*decisive.result);
      rows.back()[6] = TrialsInWords(*decisive.result, result.checks[c]);
    }
  }
  return rows;
}

// The verdicts: of the claims, and beside them those of a study's conditions where they fit on a page.
std::string VerdictTableAsMarkdown(const Audit& audit) {
  constexpr size_t kMostColumns = 8;
  size_t num_columns = 0;
  for (const Claim& claim : audit.claims) {
    if (IsOnStudy(audit)) num_columns = std::max(num_columns, claim.checks.size());
  }
  const bool has_columns = num_columns > 1 && num_columns <= kMostColumns;
  std::string header = "| claim | reading | verdict |", rule = "|---|---|---|", rows;
  for (size_t c = 0; has_columns && c < num_columns; ++c) {
    header += fmt::format(" {} |", ConditionsInWords(audit.claims.front().checks[c]));
    rule += "---|";
  }
  for (size_t i = 0; i < audit.claims.size(); ++i) {
    const Claim& claim = audit.claims[i];
    rows += fmt::format("| {} | {} | {} |", claim.id, claim.reading, VerdictInWords(claim, audit.results[i]));
    for (size_t c = 0; has_columns && c < num_columns; ++c) {
      rows += fmt::format(" {} |", VerdictInWords(claim.checks[c], audit.results[i].checks[c]));
    }
    rows += "\n";
  }
  return header + "\n" + rule + "\n" + rows;
}

}  // namespace

std::string PlanAsTable(const Audit& plan) {
  const Budget budget = plan.options.budget;
  std::vector<std::vector<std::string>> rows = {
      {"claim", "checks", "holds at nominal", "quantity", "claimed", "trials", "found with p = 0.9"}};
  for (const Claim& claim : plan.claims) {
    const Check& check = claim.checks.front();
    const std::string holds = fmt::format("{:.3f}", HoldsAtNominal(claim, budget, plan.confidence));
    for (const Target& target : check.targets) {
      if (!target.IsClaimed()) continue;
      rows.push_back({claim.id, fmt::format("{}", claim.checks.size()), holds, target.quantity,
                      ClaimedInWords(target), fmt::format("{}", check.limits.Max(budget)),
                      PowerInWords(plan, check, target)});
    }
  }
  return fmt::format("Seed {}, budget {}. {}\n\n{}", plan.options.seed, BudgetName(budget),
                     ErrorStatement(plan), FormatColumns(rows));
}

std::string AuditAsTable(const Audit& audit) {
  if (IsOnStudy(audit)) return FormatColumns(RowsPerCondition(audit)) + "\n" + ErrorStatement(audit) + "\n";
  std::vector<std::vector<std::string>> rows = {
      {"claim", "verdict", "quantity", "sigma_px", "claimed", "found (p = 0.9)", "measured", "n"}};
  for (size_t i = 0; i < audit.claims.size(); ++i) {
    const Claim& claim = audit.claims[i];
    const Decisive decisive = DecisiveOf(claim, audit.results[i], 0, claim.checks.size());
    if (!decisive.target) {
      rows.push_back({claim.id, VerdictInWords(claim, audit.results[i]),
                      audit.results[i].checks.front().not_possible, "", "", "", "", ""});
      continue;
    }
    rows.push_back({claim.id, VerdictInWords(claim, audit.results[i]), decisive.target->quantity,
                    fmt::format("{}", decisive.check->sigma_px.value_or(kAssertedSigmaPx)),
                    ClaimedInWords(*decisive.target), PowerInWords(audit, *decisive.check, *decisive.target),
                    MeasuredInWords(*decisive.result), fmt::format("{}", decisive.result->n)});
  }
  return FormatColumns(rows) + "\n" + ErrorStatement(audit) + "\n";
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
  return JsonText(kAuditFormat, json);
}

std::string AuditAsMarkdown(const Audit& audit) {
  std::string text =
      fmt::format("# Claim audit{}\n\nSeed {}, budget {}. {}\n\n{}",
                  IsOnStudy(audit) ? " on study " + audit.options.study : "", audit.options.seed,
                  BudgetName(audit.options.budget), ErrorStatement(audit), VerdictTableAsMarkdown(audit));
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
