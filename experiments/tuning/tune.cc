#include "experiments/tuning/tune.h"

#include <fmt/format.h>

#include <numeric>

#include "experiments/run/run_trials.h"
#include "experiments/trial/trial.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

void AddTrial(const std::vector<TrialRecord>& records, const FailureBounds& bounds,
              std::vector<VerifiedEstimator>* verified) {
  std::vector<bool> is_bad;
  for (const TrialRecord& record : records) is_bad.push_back(HasFailedOrRefused(record, bounds));
  for (size_t e = 0; e < records.size(); ++e) {
    VerifiedEstimator& counts = (*verified)[e];
    for (ErrorCount* count : {&counts.failure, &counts.refusal, &counts.failure_or_refusal}) ++count->n;
    counts.failure.errors += HasFailed(records[e], bounds);
    counts.refusal.errors += HasRefused(records[e]);
    counts.failure_or_refusal.errors += is_bad[e];
    counts.against_first.Add(is_bad[0], is_bad[e]);
  }
}

std::vector<std::uint32_t> AllConditions(const StudyPlan& plan) {
  std::vector<std::uint32_t> all(plan.conditions.size());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

// The plain estimator must do what was decided from traces.
void CheckAgreement(const VerifiedEstimator& plain, const SettingCount& decided) {
  if (plain.failure.errors == decided.failures && plain.refusal.errors == decided.refusals) return;
  throw std::logic_error(
      fmt::format("tune: {} failures and {} refusals by plain calls, {} and {} decided from traces",
                  plain.failure.errors, plain.refusal.errors, decided.failures, decided.refusals));
}

}  // namespace

TuningTrials::TuningTrials(const Tuning& tuning) {
  std::uint32_t first = 0;
  const auto next = [&first](int n) {
    const TrialRange range{first, first + static_cast<std::uint32_t>(n)};
    first = range.end;
    return range;
  };
  explore = next(tuning.explore);
  calibrate = next(tuning.calibrate);
  verify = next(tuning.verify);
}

void CheckTrialsSuffice(const Tuning& tuning, size_t num_conditions) {
  const std::string why = WhyTooFewTrials(tuning, num_conditions);
  if (!why.empty()) throw InputError("tune: " + why);
}

std::vector<std::string> DescribeEachSetting(const Tuning& tuning, const SettingPlan& settings) {
  std::vector<std::string> names;
  for (const TunedSetting& setting : settings.settings) {
    std::vector<std::string> words;
    for (size_t i = 0; i < setting.levels.size(); ++i) {
      words.push_back(fmt::format("{} = {}", tuning.options[i].name, setting.levels[i]));
    }
    names.push_back(fmt::format("{}", fmt::join(words, ", ")));
  }
  return names;
}

StudyPlan PlanWithTuned(const StudyPlan& plan, const SettingPlan& settings, size_t tuned) {
  StudyPlan with = plan;
  with.study.estimators.insert(with.study.estimators.begin(), settings.settings[tuned].spec);
  with.estimators.insert(with.estimators.begin(), settings.estimators[tuned]);
  return with;
}

TuneResult Tune(const StudyPlan& plan, const SettingPlan& settings, Unreached unreached,
                const TuningSource& source) {
  const Tuning& tuning = *plan.study.tuning;
  CheckTrialsSuffice(tuning, plan.conditions.size());
  const TuningTrials trials(tuning);
  const auto count_all = [&](TrialRange range) { return SumOver(source.count(range), AllConditions(plan)); };
  TuneResult result;
  result.settings = DescribeEachSetting(tuning, settings);
  result.explored = count_all(trials.explore);
  result.calibrated = count_all(trials.calibrate);
  result.choice = ChooseSetting(tuning, result.settings, result.explored, result.calibrated);
  if (!result.choice.setting && unreached == Unreached::kStop) return result;
  result.verified = count_all(trials.verify);
  if (!result.choice.setting) return result;
  const size_t tuned = *result.choice.setting;
  result.estimators = source.verify(tuned);
  CheckAgreement(result.estimators.front(), result.verified[tuned]);
  return result;
}

Choice ChooseFrom(const StudyPlan& plan, const SettingPlan& settings, const TuningSource& source) {
  const Tuning& tuning = *plan.study.tuning;
  const TuningTrials trials(tuning);
  const auto count_all = [&](TrialRange range) { return SumOver(source.count(range), AllConditions(plan)); };
  return ChooseSetting(tuning, DescribeEachSetting(tuning, settings), count_all(trials.explore),
                       count_all(trials.calibrate));
}

std::vector<VerifiedEstimator> VerifyEstimators(const StudyPlan& plan, TrialRange trials) {
  std::vector<VerifiedEstimator> verified;
  for (const EstimatorSpec& spec : plan.study.estimators) verified.push_back({spec, {}, {}, {}, {}});
  ForEachTrial(plan, trials, [&](const Condition& condition, std::uint32_t trial, std::int64_t) {
    const TrialResult result = RunTrialOfDraw(plan, condition, trial);
    if (result.why_not_simulated.empty()) AddTrial(result.records, plan.study.failure, &verified);
  });
  return verified;
}

}  // namespace rcme
