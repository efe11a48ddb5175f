#include "experiments/tuning/transfer_output.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "experiments/core/table/render_table.h"
#include "experiments/core/table/table.h"
#include "experiments/core/text/json_output.h"
#include "experiments/trial/simulate_draw.h"
#include "experiments/tuning/tune_json.h"
#include "experiments/tuning/tune_output.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

// The other families on which a family's choice has this verdict.
std::vector<std::string> OthersWith(Verdict verdict, const Tuning& tuning, const TransferResult& result,
                                    size_t family) {
  std::vector<std::string> words;
  for (size_t other = 0; other < result.families.size(); ++other) {
    if (other == family) continue;
    const SettingCount& count = result.verified[other][*result.families[family].choice.setting];
    if (DecideSetting(tuning, count) == verdict) words.push_back(result.families[other].words);
  }
  return words;
}

// One row per family tuned on and family verified on, without families that have no choice.
Table MakeTransferCells(const StudyPlan& plan, const TransferResult& result) {
  const Tuning& tuning = *plan.study.tuning;
  Table table{{Column::Key("tuned_on"), Column::Text("setting"), Column::Key("verified_on")}};
  for (const char* rate : {"rate", "failure", "refusal", "false_refusal"}) {
    table.columns.push_back(Column::Estimated(rate));
    table.columns.push_back(Column::Count(std::string(rate) + "_n"));
  }
  table.columns.push_back(Column::Text("verdict"));
  for (size_t f = 0; f < result.families.size(); ++f) {
    const Family& family = result.families[f];
    if (!family.choice.setting) continue;
    for (size_t other = 0; other < result.families.size(); ++other) {
      const SettingCount& count = result.verified[other][*family.choice.setting];
      std::vector<Value>& row = table.rows.emplace_back();
      row = {family.words, result.settings[*family.choice.setting], result.families[other].words};
      for (const ErrorCount& of :
           {TargetedCount(tuning, count), count.Failure(), count.Refusal(), count.FalseRefusal()})
        row.insert(row.end(), {EstimateRate(of), of.n});
      row.emplace_back(Name(DecideSetting(tuning, count)));
    }
  }
  return WithIntervalColumns(table);
}

std::string TransferAsTable(const StudyPlan& plan, const TransferResult& result) {
  const Tuning& tuning = *plan.study.tuning;
  Table table{{Column::Key("tuned on"), Column::Text("setting"),
               Column::Estimated("there, fresh trials", kPercent), Column::Count("others: holds"),
               Column::Count("undecided"), Column::Count("does not hold"), Column::Text("does not hold on")}};
  for (size_t f = 0; f < result.families.size(); ++f) {
    const Family& family = result.families[f];
    std::vector<Value>& row = table.rows.emplace_back();
    if (family.choice.setting) {
      const auto with = [&](Verdict verdict) { return OthersWith(verdict, tuning, result, f); };
      const std::vector<std::string> violated = with(Verdict::kDoesNotHold);
      row = {family.words,
             result.settings[*family.choice.setting],
             EstimateRate(TargetedCount(tuning, result.verified[f][*family.choice.setting])),
             std::ssize(with(Verdict::kHolds)),
             std::ssize(with(Verdict::kUndecided)),
             std::ssize(violated),
             fmt::format("{}", fmt::join(violated, "; "))};
    } else {
      row = {family.words, "none: " + family.choice.why};
      row.resize(table.columns.size());
    }
  }
  const std::int64_t num_trials = tuning.verify * std::ssize(plan.conditions);
  std::int64_t num_simulated = 0;
  for (const std::vector<SettingCount>& counts : result.verified) num_simulated += counts.front().n;
  return FormatParagraph(fmt::format(
             "{}: {} tuned on one family, verified on all; {} trials to verify a family of one condition",
             plan.study.name, tuning.estimator, tuning.verify)) +
         FormatParagraph("Target: " + DescribeTarget(tuning)) +
         FormatParagraph(DescribeNotSimulated(num_trials - num_simulated, num_trials)) + "\n" +
         RenderText(table);
}

std::string TransferAsJson(const StudyPlan& plan, const SettingPlan& settings, const TransferResult& result) {
  const Tuning& tuning = *plan.study.tuning;
  Json families = Json::array(), cells = Json::array();
  for (size_t f = 0; f < result.families.size(); ++f) {
    const Family& family = result.families[f];
    const std::optional<size_t>& s = family.choice.setting;
    families.push_back({{"words", family.words},
                        {"levels", s ? Json(settings.settings[*s].levels) : Json(nullptr)},
                        {"why", family.choice.why}});
    for (size_t other = 0; s && other < result.families.size(); ++other) {
      const SettingCount& count = result.verified[other][*s];
      cells.push_back({{"tuned_on", f},
                       {"verified_on", other},
                       {"rate", RateAsJson(TargetedCount(tuning, count))},
                       {"failure", RateAsJson(count.Failure())},
                       {"refusal", RateAsJson(count.Refusal())},
                       {"false_refusal", RateAsJson(count.FalseRefusal())},
                       {"verdict", Name(DecideSetting(tuning, count))}});
    }
  }
  const Json json = {{"study", plan.study.name},
                     {"estimator", tuning.estimator},
                     {"seed", plan.study.seed},
                     {"target", TargetAsJson(tuning)},
                     {"options", OptionsAsJson(plan.study)},
                     {"rows", RenderJson(MakeTransferCells(plan, result))},
                     {"families", families},
                     {"cells", cells}};
  return JsonText(kTransferFormat, json);
}

}  // namespace

CommandResult MakeTransferResult(const StudyPlan& plan, const SettingPlan& settings,
                                 const TransferResult& result) {
  return {TransferAsTable(plan, result), MakeTransferCells(plan, result),
          TransferAsJson(plan, settings, result)};
}

}  // namespace rcme
