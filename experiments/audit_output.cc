#include "experiments/audit_output.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/claims/case.h"
#include "experiments/summary_output.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

const char* BudgetName(Budget budget) { return budget == Budget::kQuick ? "quick" : "full"; }

const char* VerdictName(const std::optional<Verdict>& verdict) {
  return verdict ? Name(*verdict) : "measured";
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

std::string VerdictInWords(const ClaimResult& result) {
  const std::string words = Name(result.verdict);
  if (result.verdict != ClaimVerdict::kSmallNoiseOnly) return words;
  return fmt::format("{} (up to {} px)", words, *result.holds_up_to_sigma_px);
}

// The target that decided the claim: of the check at the asserted noise level (or the nearest below), the
// first that does not hold, else the first undecided, else the first.
struct Decisive {
  const Check* check;
  const Target* target;
  const TargetResult* result;
};

Decisive DecisiveOf(const Claim& claim, const ClaimResult& result) {
  const auto distance = [](const Check& check) {
    const double excess = check.sigma_px - kAssertedSigmaPx;
    return excess > 0.0 ? 1e3 + excess : -excess;
  };
  const auto severity = [](const std::optional<Verdict>& verdict) {
    return !verdict ? 0 : *verdict == Verdict::kHolds ? 1 : *verdict == Verdict::kUndecided ? 2 : 3;
  };
  Decisive best{nullptr, nullptr, nullptr};
  for (size_t c = 0; c < claim.checks.size(); ++c) {
    for (size_t t = 0; t < claim.checks[c].targets.size(); ++t) {
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

Json TargetAsJson(const Target& target, const TargetResult& result) {
  const char* kind = target.kind == Target::Kind::kMean ? "mean" : "rate";
  Json json = {{"quantity", target.quantity},
               {"kind", kind},
               {"nominal", Number(target.nominal)},
               {"low", Number(target.allowed.lower)},
               {"high", Number(target.allowed.upper)},
               {"threshold", Number(target.threshold)},
               {"measured", Number(result.measured)},
               {"interval", {Number(result.interval.lower), Number(result.interval.upper)}},
               {"n", result.n},
               {"verdict", VerdictName(result.verdict)}};
  json["trials_to_decide"] = result.verdict == Verdict::kUndecided ? Number(result.trials_to_decide) : Json();
  return json;
}

Json CheckAsJson(const Check& check, const CheckResult& result) {
  Json json = {{"conditions", Json::object()},
               {"num_trials", result.num_trials},
               {"verdict", VerdictName(result.verdict)},
               {"targets", Json::array()}};
  json["conditions"]["sigma_px"] = fmt::format("{}", check.sigma_px);
  for (const auto& [key, value] : check.conditions) json["conditions"][key] = value;
  for (size_t t = 0; t < check.targets.size(); ++t) {
    json["targets"].push_back(TargetAsJson(check.targets[t], result.targets[t]));
  }
  return json;
}

Json ClaimAsJson(const Claim& claim, const ClaimResult& result) {
  Json json = {{"id", claim.id},
               {"family", claim.family()},
               {"label", claim.label},
               {"reading", claim.reading},
               {"sentence", claim.sentence},
               {"statistic", claim.statistic},
               {"verdict", Name(result.verdict)}};
  json["holds_up_to_sigma_px"] = result.holds_up_to_sigma_px ? Json(*result.holds_up_to_sigma_px) : Json();
  json["figure_x"] = claim.figure_x;
  json["evidence"] = Json::array();
  for (size_t c = 0; c < claim.checks.size(); ++c) {
    json["evidence"].push_back(CheckAsJson(claim.checks[c], result.checks[c]));
  }
  return json;
}

std::string ClaimAsMarkdown(const Claim& claim, const ClaimResult& result) {
  std::string text =
      fmt::format("### {} ({})\n\n{}: \"{}.\" Measured: {}.\n\n**{}**\n\n", claim.id, claim.reading,
                  claim.label, claim.sentence, claim.statistic, VerdictInWords(result));
  text += "| conditions | quantity | claimed | measured | n | verdict |\n|---|---|---|---|---|---|\n";
  for (size_t c = 0; c < claim.checks.size(); ++c) {
    for (size_t t = 0; t < claim.checks[c].targets.size(); ++t) {
      const TargetResult& target = result.checks[c].targets[t];
      std::string verdict = VerdictName(target.verdict);
      if (target.verdict == Verdict::kUndecided) {
        verdict += std::isfinite(target.trials_to_decide)
                       ? fmt::format(" (about {:.2g} trials would do)", target.trials_to_decide)
                       : " (no number of trials may do)";
      }
      text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", ConditionsInWords(claim.checks[c]),
                          claim.checks[c].targets[t].quantity, ClaimedInWords(claim.checks[c].targets[t]),
                          MeasuredInWords(target), target.n, verdict);
    }
  }
  return text + "\n";
}

std::string ErrorStatement(const Audit& audit) {
  return fmt::format(
      "Intervals hold at all sample sizes at once, each with confidence 1 - {:.2g}; the probability of any "
      "false "
      "verdict among all {} claimed numbers is at most {}.",
      1.0 - audit.confidence, audit.num_targets, kAuditErrorRate);
}

}  // namespace

std::string AuditAsTable(const Audit& audit) {
  std::vector<std::vector<std::string>> rows = {
      {"claim", "verdict", "quantity", "sigma_px", "claimed", "measured", "n"}};
  for (size_t i = 0; i < audit.claims.size(); ++i) {
    const Decisive decisive = DecisiveOf(audit.claims[i], audit.results[i]);
    rows.push_back({audit.claims[i].id, VerdictInWords(audit.results[i]), decisive.target->quantity,
                    fmt::format("{}", decisive.check->sigma_px), ClaimedInWords(*decisive.target),
                    MeasuredInWords(*decisive.result), fmt::format("{}", decisive.result->n)});
  }
  return FormatColumns(rows) + "\n" + ErrorStatement(audit) + "\n";
}

std::string AuditAsJson(const Audit& audit) {
  Json json = {{"format", "rcme audit 1"},
               {"seed", audit.options.seed},
               {"budget", BudgetName(audit.options.budget)},
               {"confidence_per_target", audit.confidence},
               {"num_targets", audit.num_targets}};
  for (const auto& [key, value] : ResolveCaseSettings({})) json["default_conditions"][key] = value;
  json["claims"] = Json::array();
  for (size_t i = 0; i < audit.claims.size(); ++i) {
    json["claims"].push_back(ClaimAsJson(audit.claims[i], audit.results[i]));
  }
  return json.dump(1) + "\n";
}

std::string AuditAsMarkdown(const Audit& audit) {
  std::string text =
      fmt::format("# Claim audit\n\nSeed {}, budget {}. {}\n\n| claim | reading | verdict |\n|---|---|---|\n",
                  audit.options.seed, BudgetName(audit.options.budget), ErrorStatement(audit));
  for (size_t i = 0; i < audit.claims.size(); ++i) {
    const Claim& claim = audit.claims[i];
    text += fmt::format("| {} | {} | {} |\n", claim.id, claim.reading, VerdictInWords(audit.results[i]));
  }
  std::string family;
  for (size_t i = 0; i < audit.claims.size(); ++i) {
    const Claim& claim = audit.claims[i];
    if (claim.family() != family) {
      family = claim.family();
      text += fmt::format("\n## {0}\n\n![{0}](audit_{0}.png)\n\n", family);
    }
    text += ClaimAsMarkdown(claim, audit.results[i]);
  }
  return text;
}

}  // namespace rcme
