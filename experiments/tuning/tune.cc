#include "experiments/tuning/tune.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "parameters/input_error.h"

namespace rcme {
namespace {

std::vector<std::uint32_t> AllConditions(const StudyPlan& plan) {
  std::vector<std::uint32_t> all(plan.conditions.size());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

std::vector<SettingCount> CountAll(const StudyPlan& plan, const SettingPlan& settings, TrialRange trials,
                                   int num_threads, Progress* progress) {
  return SumOver(CountOutcomes(plan, settings, trials, num_threads, progress), AllConditions(plan));
}

// What the plain estimator does must be what was decided from traces.
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

std::vector<std::string> SettingsInWords(const Tuning& tuning, const SettingPlan& settings) {
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
  result.settings = SettingsInWords(tuning, settings);
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
  return ChooseSetting(tuning, SettingsInWords(tuning, settings), count_all(trials.explore),
                       count_all(trials.calibrate));
}

Repetitions RepeatTuning(const StudyPlan& plan, const SettingPlan& settings, int n, int num_threads) {
  const Tuning& tuning = *plan.study.tuning;
  CheckTrialsSuffice(tuning, plan.conditions.size());
  if (tuning.target == TuneTarget::kRisk) {
    throw InputError("--repeat: target: risk: the least risk is no limit that a repetition could violate");
  }
  const TuningTrials trials(tuning);
  const std::vector<std::string> names = SettingsInWords(tuning, settings);
  Repetitions repetitions;
  const std::int64_t per_condition = n * (tuning.explore + 1LL * tuning.calibrate) + tuning.verify;
  Progress progress("trials", per_condition * static_cast<std::int64_t>(plan.conditions.size()));
  repetitions.reference = CountAll(plan, settings, trials.verify, num_threads, &progress);
  repetitions.num_chosen.resize(names.size());
  for (int r = 1; r <= n; ++r) {
    StudyPlan fresh = plan;
    fresh.study.seed += static_cast<std::uint64_t>(r);
    const Choice choice =
        ChooseSetting(tuning, names, CountAll(fresh, settings, trials.explore, num_threads, &progress),
                      CountAll(fresh, settings, trials.calibrate, num_threads, &progress));
    ++repetitions.num_done;
    if (!choice.setting) {
      ++repetitions.num_without_choice;
      continue;
    }
    ++repetitions.num_chosen[*choice.setting];
    const Verdict verdict = VerdictOf(tuning, repetitions.reference[*choice.setting]);
    repetitions.num_violated += verdict == Verdict::kDoesNotHold;
    repetitions.num_undecided += verdict == Verdict::kUndecided;
  }
  return repetitions;
}

}  // namespace rcme
