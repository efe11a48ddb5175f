#include "experiments/tuning/transfer.h"

#include <fmt/format.h>

#include <algorithm>

#include "parameters/input_error.h"

namespace rcme {
namespace {

std::string DescribeCondition(const StudyPlan& plan, const Condition& condition) {
  std::vector<std::string> words;
  for (size_t f = 0; f < plan.factor_names.size(); ++f) {
    words.push_back(fmt::format("{} = {}", plan.factor_names[f], condition.levels[f]));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

// The short name of a condition of a one-at-a-time study: its difference from the first condition.
std::string DescribeDifference(const StudyPlan& plan, const Condition& condition) {
  std::vector<std::string> words;
  for (size_t f = 0; f < plan.factor_names.size(); ++f) {
    if (condition.levels[f] == plan.conditions.front().levels[f]) continue;
    words.push_back(fmt::format("{} = {}", plan.factor_names[f], condition.levels[f]));
  }
  return words.empty() ? "base" : fmt::format("{}", fmt::join(words, ", "));
}

std::vector<Family> EveryCondition(const StudyPlan& plan) {
  std::vector<Family> families;
  for (const Condition& condition : plan.conditions) {
    families.push_back({plan.study.design == Design::kOneAtATime ? DescribeDifference(plan, condition)
                                                                 : DescribeCondition(plan, condition),
                        {condition.index},
                        {}});
  }
  return families;
}

std::vector<Family> FamiliesBy(const StudyPlan& plan, const std::string& by) {
  if (by.empty()) return EveryCondition(plan);
  const auto factor = std::ranges::find(plan.factor_names, by);
  if (factor == plan.factor_names.end()) {
    throw InputError(fmt::format("--by {}: the study has no such factor; its factors: {}", by,
                                 fmt::join(plan.factor_names, ", ")));
  }
  const auto f = static_cast<size_t>(factor - plan.factor_names.begin());
  std::vector<Family> families;
  for (const Condition& condition : plan.conditions) {
    const std::string words = fmt::format("{} = {}", by, condition.levels[f]);
    auto family = std::ranges::find(families, words, &Family::words);
    if (family == families.end()) family = families.insert(families.end(), {words, {}, {}});
    family->conditions.push_back(condition.index);
  }
  return families;
}

void CheckFamilies(const StudyPlan& plan, const std::vector<Family>& families) {
  const Tuning& tuning = *plan.study.tuning;
  if (tuning.target == TuneTarget::kRisk) {
    throw InputError(
        "transfer: target: risk: a least risk has no limit that could be violated; give another target");
  }
  if (families.size() < 2) throw InputError("transfer: the study has one family of scenes; two are needed");
  for (const Family& family : families) {
    CheckTrialsSuffice(tuning, family.conditions.size());
  }
}

}  // namespace

std::vector<Family> ListFamilies(const StudyPlan& plan, const std::string& by) {
  std::vector<Family> families = FamiliesBy(plan, by);
  CheckFamilies(plan, families);
  return families;
}

TransferResult MeasureTransfer(const StudyPlan& plan, const SettingPlan& settings, const std::string& by,
                               const TuningSource& source) {
  const Tuning& tuning = *plan.study.tuning;
  TransferResult result;
  result.families = ListFamilies(plan, by);
  result.settings = DescribeEachSetting(tuning, settings);
  const TuningTrials trials(tuning);
  const SettingCounts explored = source.count(trials.explore), calibrated = source.count(trials.calibrate);
  const SettingCounts verified = source.count(trials.verify);
  for (Family& family : result.families) {
    family.choice = ChooseSetting(tuning, result.settings, SumOver(explored, family.conditions),
                                  SumOver(calibrated, family.conditions));
    result.verified.push_back(SumOver(verified, family.conditions));
  }
  return result;
}

}  // namespace rcme
