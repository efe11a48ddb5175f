#include "experiments/audit/claims/audit_json.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "experiments/audit/claims/audit_words.h"
#include "experiments/audit/claims/power.h"
#include "experiments/core/text/field_text.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

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

}  // namespace

Json AuditAsJson(const Audit& audit) {
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
  return json;
}

}  // namespace rcme
