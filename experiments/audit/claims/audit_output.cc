#include "experiments/audit/claims/audit_output.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>

#include "experiments/audit/claims/audit.h"
#include "experiments/audit/claims/audit_words.h"
#include "experiments/audit/claims/power.h"
#include "experiments/core/table/render_table.h"
#include "experiments/core/text/field_text.h"
#include "experiments/core/text/json_output.h"

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

// Claims, conditions, targets, intervals, verdicts; the input of plots/audit.py. Unknown or unbounded numbers
// are null.
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

Estimate MakeEstimate(const TargetResult& result) { return {result.measured, result.interval}; }

// The target that decided the checks [begin, end) of a claim. It belongs to the check at the asserted noise
// level (or the nearest below), and is the first that does not hold, else the first undecided one, else the
// first. Null if none of the checks has a target.
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

// One row per claim and condition of a study. If there are several conditions, a row for all of them
// precedes.
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

// One row per claimed or measured number.
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
                                  BudgetName(plan.options.budget), DescribeErrors(plan))) +
      "\n" + RenderText(MakePlanTable(plan));
  return MakeResult(text, kAuditPlanFormat,
                    {{"seed", static_cast<std::int64_t>(plan.options.seed)},
                     {"budget", BudgetName(plan.options.budget)},
                     {"confidence_per_target", plan.confidence}},
                    MakePlanTable(plan));
}

CommandResult MakeAuditResult(const Audit& audit) {
  const std::string text = RenderText(IsOnStudy(audit) ? MakeConditionTable(audit) : MakeClaimTable(audit)) +
                           "\n" + FormatParagraph(DescribeErrors(audit));
  const Table rows = MakeNumberTable(audit);
  nlohmann::ordered_json json = AuditAsJson(audit);
  json["rows"] = RenderJson(rows);
  return {text, rows, JsonText(kAuditFormat, json)};
}

}  // namespace rcme
