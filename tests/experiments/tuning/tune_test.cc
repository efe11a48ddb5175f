#include "experiments/tuning/tune.h"

#include <gtest/gtest.h>

#include <map>
#include <mutex>
#include <set>

#include "experiments/trial/trial.h"
#include "experiments/tuning/tune_json.h"
#include "experiments/tuning/tuning_work.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/in_memory.h"
#include "tests/test_support/match_text.h"
#include "tests/test_support/temp_folder.h"
#include "tests/test_support/tuned_study.h"

namespace rcme {
namespace {

// 10 trials of each condition to explore, 20 to calibrate, 10 to verify.
const std::string kBlock =
    "  target: failure\n"
    "  at_most: 0.3\n"
    "  max_refusal: 0.9\n"
    "  explore: 10\n"
    "  calibrate: 20\n"
    "  verify: 10\n"
    "  options: {mu: [1, 2, 3], lambda: [0.5, 1]}\n";

TuneResult TuneIt(const StudyPlan& plan, int num_threads = 2, Unreached unreached = Unreached::kVerifyAll) {
  return TuneInMemory(plan, MakeTunedSettings(plan), unreached, num_threads);
}

std::string RenderTuning(const StudyPlan& plan, const TuneResult& result) {
  return TuneAsJson(plan, MakeTunedSettings(plan), result, {}) + Text(result.explored) +
         Text(result.calibrated);
}

// A condition's data; from trial `first_bad` on without a match, so that nothing can be estimated. Notes
// which trials are asked for.
class WatchedData : public DataSource {
 public:
  struct Log {
    std::mutex mutex;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> times;  // (condition, trial)
    std::set<std::uint64_t> seeds;
  };
  WatchedData(std::shared_ptr<const DataSource> data, std::uint32_t first_bad, Log* log)
      : data_(std::move(data)), first_bad_(first_bad), log_(log) {}
  int NumTrials(int trials) const override { return trials; }
  TrialData Make(const StreamName& name) const override {
    {
      const std::lock_guard lock(log_->mutex);
      ++log_->times[{name.condition, name.trial}];
      log_->seeds.insert(name.seed);
    }
    TrialData data = data_->Make(name);
    if (name.trial < first_bad_) return data;
    data.problem.matches.clear();
    data.truth.is_inlier_true.clear();
    return data;
  }

 private:
  std::shared_ptr<const DataSource> data_;
  std::uint32_t first_bad_;
  Log* log_;
};

StudyPlan Watched(StudyPlan plan, WatchedData::Log* log, std::uint32_t first_bad = 1000) {
  for (Condition& condition : plan.conditions) {
    condition.source = std::make_shared<WatchedData>(condition.source, first_bad, log);
  }
  return plan;
}

TEST(Tune, EveryStageHasTrialsOfItsOwn) {
  const TuningTrials trials(*TunedPlan(kBlock).study.tuning);
  EXPECT_EQ(trials.explore.first, 0u);
  EXPECT_EQ(trials.explore.end, 10u);
  EXPECT_EQ(trials.calibrate.first, 10u);
  EXPECT_EQ(trials.calibrate.end, 30u);
  EXPECT_EQ(trials.verify.first, 30u);
  EXPECT_EQ(trials.verify.end, 40u);
}

// Those for verification: of all settings, by plain calls, and for the entropies.
TEST(Tune, EveryTrialIsMadeOnceAndThoseForVerificationThrice) {
  WatchedData::Log log;
  const TuneResult result = TuneIt(Watched(TunedPlan(kBlock), &log));
  ASSERT_TRUE(result.choice.setting.has_value()) << result.choice.why;
  EXPECT_EQ(log.times.size(), 2u * 40u);
  for (const auto& [name, times] : log.times) {
    EXPECT_EQ(times, name.second < 30 ? 1 : 3) << "condition " << name.first << " trial " << name.second;
  }
}

// What the trials for verification show changes nothing before them, and the other way round.
TEST(Tune, TheStagesDoNotSeeEachOthersTrials) {
  WatchedData::Log log;
  const StudyPlan plan = TunedPlan(kBlock);
  const TuneResult whole = TuneIt(plan), no_verify = TuneIt(Watched(plan, &log, 30)),
                   no_calibrate = TuneIt(Watched(plan, &log, 10));
  EXPECT_EQ(Text(no_verify.explored), Text(whole.explored));
  EXPECT_EQ(Text(no_verify.calibrated), Text(whole.calibrated));
  EXPECT_EQ(no_verify.choice.setting, whole.choice.setting);
  for (const SettingCount& count : no_verify.verified) EXPECT_EQ(count.refusals, 20);
  ASSERT_FALSE(no_verify.estimators.empty());
  EXPECT_EQ(no_verify.estimators[0].refusal.errors, 20);
  EXPECT_EQ(Text(no_calibrate.explored), Text(whole.explored));
  EXPECT_EQ(no_calibrate.choice.path, whole.choice.path);
  EXPECT_FALSE(no_calibrate.choice.setting.has_value());
  EXPECT_TRUE(no_calibrate.estimators.empty());
}

TEST(Tune, VerifiesTheTunedEstimatorAndThoseOfTheStudyOnTheLastTrials) {
  const StudyPlan plan = TunedPlan(kBlock);
  const TuneResult result = TuneIt(plan);
  ASSERT_TRUE(result.choice.setting.has_value()) << result.choice.why;
  Study study = plan.study;
  study.estimators.insert(study.estimators.begin(),
                          MakeTunedSettings(plan).settings[*result.choice.setting].spec);
  study.estimators[0].label = "tuned";
  const StudyPlan with_tuned = MakePlan(study);
  std::vector<VerifiedEstimator> expected(3);
  for (const Condition& condition : with_tuned.conditions) {
    for (std::uint32_t trial = 30; trial < 40; ++trial) {
      const std::vector<TrialRecord> records = RunTrial(with_tuned, condition, trial).records;
      const auto is_bad = [&](size_t e) { return !HasSucceeded(records[e], study.failure); };
      for (size_t e = 0; e < 3; ++e) {
        expected[e].failure.errors += HasFailed(records[e], study.failure);
        expected[e].refusal.errors += records[e].status != MotionStatus::kOk;
        expected[e].failure_or_refusal.errors += is_bad(e);
        expected[e].against_first.Add(is_bad(0), is_bad(e));
      }
    }
  }
  ASSERT_EQ(result.estimators.size(), 3u);
  for (size_t e = 0; e < 3; ++e) {
    const VerifiedEstimator& counts = result.estimators[e];
    EXPECT_EQ(counts.failure.n, 20);
    EXPECT_EQ(counts.failure.errors, expected[e].failure.errors) << e;
    EXPECT_EQ(counts.refusal.errors, expected[e].refusal.errors) << e;
    EXPECT_EQ(counts.failure_or_refusal.errors, expected[e].failure_or_refusal.errors) << e;
    EXPECT_EQ(counts.against_first.first_only, expected[e].against_first.first_only) << e;
    EXPECT_EQ(counts.against_first.second_only, expected[e].against_first.second_only) << e;
  }
  EXPECT_EQ(result.estimators[1].spec.label, "standard");
  EXPECT_EQ(result.estimators[2].spec.label, "ours");
  EXPECT_GT(expected[2].against_first.first_only + expected[2].against_first.second_only, 0)
      << "the tuned one does as the study's: the check has no power";
}

TEST(Tune, DoesNotDependOnThreads) {
  const StudyPlan plan = TunedPlan(kBlock);
  EXPECT_EQ(RenderTuning(plan, TuneIt(plan, 1)), RenderTuning(plan, TuneIt(plan, 4)));
}

// The number of trials that `rcme run` would take, and everything but the block, has no say.
TEST(Tune, IsAFunctionOfSeedAndBlock) {
  StudyPlan plan = TunedPlan(kBlock), other = plan;
  const std::string whole = RenderTuning(plan, TuneIt(plan));
  plan.study.trials = 77;
  EXPECT_EQ(RenderTuning(plan, TuneIt(plan)), whole);
  other.study.seed = 4;
  EXPECT_NE(RenderTuning(other, TuneIt(other)), whole);
}

// Verification takes the most time, and without a choice only a figure shows it.
TEST(Tune, WithoutAChoiceItMayStop) {
  StudyPlan plan = TunedPlan(kBlock);
  plan.study.tuning->max_refusal = 0.15;
  WatchedData::Log log;
  const TuneResult stopped = TuneIt(Watched(plan, &log), 2, Unreached::kStop), whole = TuneIt(plan);
  EXPECT_FALSE(whole.choice.setting.has_value());
  EXPECT_EQ(stopped.choice.why, whole.choice.why);
  EXPECT_EQ(log.times.size(), 2u * 30u);
  EXPECT_TRUE(stopped.verified.empty());
  EXPECT_EQ(whole.verified.size(), 6u);
  plan.study.tuning->max_refusal = 0.9;
  EXPECT_EQ(RenderTuning(plan, TuneIt(plan, 2, Unreached::kStop)), RenderTuning(plan, TuneIt(plan)));
}

TEST(Tune, TooFewTrialsAreRefusedBeforeAnyIsRun) {
  WatchedData::Log log;
  StudyPlan plan = Watched(TunedPlan(kBlock), &log);
  plan.study.tuning->calibrate = 4;  // 0.7^9 = 0.040
  EXPECT_TRUE(ThrowsInputError([&] { TuneIt(plan); }, {"tune: calibrate: 4 in each of 2 conditions", "30 %",
                                                       "delta 0.05", "9 trials would do", "calibrate: 5"}));
  EXPECT_TRUE(log.times.empty());
  plan.study.tuning->calibrate = 5;
  EXPECT_NO_THROW(TuneIt(plan));
}

TEST(Tune, RealPairsAreRefused) {
  const TempFolder folder;
  folder.Write("1.csv", MatchHeader() + TruePoseHeader() + MatchRows(60));
  const StudyPlan plan = MakePlan(
      ParseStudy("data: {scene: match_files, folder: '" + folder.path() +
                     "'}\nestimators: [{name: rcme}]\ntune: {estimator: rcme, options: {mu: [1, 2]}}\n",
                 "real.yaml"));
  EXPECT_TRUE(ThrowsInputError([&] { TuneIt(plan); }, {"match_files", "fresh trials"}));
}

TEST(Tune, WeightedTrialsAreRefused) {
  Study study = TunedPlan(kBlock).study;
  study.data.emplace_back("outlier_count", "bernoulli");
  study.data.emplace_back("tilted_to", "0.6");
  EXPECT_TRUE(ThrowsInputError([&] { TuneIt(MakePlan(study)); }, {"tilted_to", "weighted trials"}));
}

TEST(Tune, OneTrialPerConditionOfEveryStage) {
  StudyPlan plan = TunedPlan(kBlock);
  Tuning& tuning = *plan.study.tuning;
  tuning.explore = tuning.calibrate = tuning.verify = 1;
  tuning.at_most = 0.8;  // 0.2^2 = 0.04
  tuning.max_refusal = 1.0;
  const TuneResult result = TuneIt(plan);
  ASSERT_TRUE(result.choice.setting.has_value()) << result.choice.why;
  EXPECT_EQ(result.verified[0].n, 2);
}

TEST(RepeatTuning, RepeatsTheTuningOfOtherSeeds) {
  StudyPlan plan = TunedPlan(kBlock);
  plan.study.tuning->at_most = 0.25;
  WatchedData::Log log;
  const StudyPlan watched = Watched(plan, &log);
  Runner runner = Runner::InMemory(PlanRepetitions(watched, 8), 2);
  const Repetitions repetitions = RepeatTuning(watched, MakeTunedSettings(watched), &runner);
  EXPECT_EQ(log.seeds.size(), 9u);
  std::vector<std::int64_t> num_chosen(6, 0);
  std::int64_t num_without = 0;
  std::map<Verdict, std::int64_t> num_with;
  const std::vector<SettingCount> reference =
      SumOver(CountOutcomes(plan, MakeTunedSettings(plan), {30, 40}), {0, 1});
  EXPECT_EQ(Text(repetitions.reference), Text(reference));
  for (std::uint64_t r = 1; r <= 8; ++r) {
    StudyPlan of_seed = plan;
    of_seed.study.seed = plan.study.seed + r;
    const std::optional<size_t> setting = TuneIt(of_seed).choice.setting;
    if (!setting) {
      ++num_without;
      continue;
    }
    ++num_chosen[*setting];
    ++num_with[DecideSetting(*plan.study.tuning, reference[*setting])];
  }
  EXPECT_EQ(repetitions.num_done, 8);
  EXPECT_EQ(repetitions.num_without_choice, num_without);
  EXPECT_EQ(repetitions.num_chosen, num_chosen);
  EXPECT_EQ(repetitions.num_violated, num_with[Verdict::kDoesNotHold]);
  EXPECT_EQ(repetitions.num_undecided, num_with[Verdict::kUndecided]);
}

TEST(RepeatTuning, ARiskIsNoPromise) {
  StudyPlan plan = TunedPlan(kBlock);
  plan.study.tuning->target = TuneTarget::kRisk;
  EXPECT_TRUE(ThrowsInputError([&] { PlanRepetitions(plan, 1); }, {"--repeat", "risk"}));
}

}  // namespace
}  // namespace rcme
