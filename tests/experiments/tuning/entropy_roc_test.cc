// What is called good and bad, trial by trial, from plain calls.
#include "experiments/tuning/entropy_roc.h"

#include <gtest/gtest.h>

#include "estimator/ransac_loop.h"
#include "experiments/trial/trial.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

struct GoodAndBad {
  std::vector<double> good, bad;
};

std::vector<EntropyRoc> Measure(const StudyPlan& plan, TrialRange trials) {
  return ComputeRocs(plan, MeasureEntropies(plan, trials));
}

void ExpectSame(const EntropyRoc& roc, const GoodAndBad& expected) {
  EXPECT_EQ(roc.good, expected.good);
  EXPECT_EQ(roc.bad, expected.bad);
  EXPECT_GT(roc.good.size(), 3u);
  EXPECT_GT(roc.bad.size(), 3u);
  double in_order = 0.0;
  for (const double good : roc.good) {
    for (const double bad : roc.bad) in_order += good < bad ? 1.0 : good == bad ? 0.5 : 0.0;
  }
  EXPECT_NEAR(roc.area.value, in_order / static_cast<double>(roc.good.size() * roc.bad.size()), 1e-12);
}

// The estimators without a quality test, with so many hypotheses.
StudyPlan WithoutTest(int num_iterations, int num_refined = 1) {
  Study study = SmallStudy();
  study.failure = {0.1, 0.4};  // degrees: some winners are good and some are bad
  for (EstimatorSpec& spec : study.estimators) {
    SetOptions(&spec, {{"num_iterations", std::to_string(num_iterations)},
                       {"num_refined", std::to_string(num_refined)}});
    if (spec.name == "rcme") SetOptions(&spec, {{"mu", "1000"}});
  }
  return MakePlan(study);
}

// The quality test of the study's estimator plays no part.
StudyPlan WithTest(int num_iterations, int num_refined = 1) {
  Study study = WithoutTest(num_iterations, num_refined).study;
  SetOptions(&study.estimators[1], {{"mu", "-50"}});
  return MakePlan(study);
}

void ExpectWinnersOfPlainCalls(int num_refined) {
  const StudyPlan plain = WithoutTest(20, num_refined);
  GoodAndBad expected;
  for (const Condition& condition : plain.conditions) {
    for (std::uint32_t trial = 5; trial < 45; ++trial) {
      const TrialRecord record = RunTrial(plain, condition, trial).records[1];
      if (record.status != MotionStatus::kOk) continue;
      (HasFailed(record, plain.study.failure) ? expected.bad : expected.good).push_back(record.mean_entropy);
    }
  }
  const std::vector<EntropyRoc> rocs = Measure(WithTest(20, num_refined), {5, 45});
  ASSERT_EQ(rocs.size(), 2u) << "the standard estimator has no entropies";
  EXPECT_EQ(rocs[0].population, "samples");
  EXPECT_EQ(rocs[1].population, "winners");
  EXPECT_EQ(rocs[1].estimator, 1u);
  ExpectSame(rocs[1], expected);
}

TEST(EntropyRoc, WinnersAreGoodWhereThePlainEstimateIs) { ExpectWinnersOfPlainCalls(1); }

// psi is that of the model that is returned, not of the best score.
TEST(EntropyRoc, OfSeveralRefinedTheOneThatIsReturnedCounts) { ExpectWinnersOfPlainCalls(8); }

// With one hypothesis the winner is the sample's model, and the sample can be drawn here.
TEST(EntropyRoc, SamplesAreGoodWhereAllEightMatchesAreTrue) {
  const StudyPlan plain = WithoutTest(1);
  GoodAndBad expected;
  for (const Condition& condition : plain.conditions) {
    for (std::uint32_t trial = 0; trial < 300; ++trial) {
      const TrialResult result = RunTrial(plain, condition, trial);
      if (result.records[1].counts.num_candidates == 0) continue;
      RandomStream rng = StreamFor(NameOfTrial(plain, condition, trial), StreamPurpose::kSampling);
      const std::vector<bool>& is_true = result.data.truth.is_inlier_true;
      int num_wrong = 0;
      for (const int i : DrawSample(8, static_cast<int>(is_true.size()), rng)) {
        num_wrong += !is_true[static_cast<size_t>(i)];
      }
      (num_wrong == 0 ? expected.good : expected.bad).push_back(result.records[1].mean_entropy);
    }
  }
  const std::vector<EntropyRoc> rocs = Measure(WithTest(1), {0, 300});
  ASSERT_FALSE(rocs.empty());
  ASSERT_EQ(rocs[0].population, "samples");
  ExpectSame(rocs[0], expected);
}

TEST(EntropyRoc, ATrialGivesOneOfEachAtMost) {
  const std::vector<EntropyRoc> rocs = Measure(WithTest(40), {0, 20});
  ASSERT_FALSE(rocs.empty());
  EXPECT_LE(rocs[0].good.size(), 40u);
  EXPECT_LE(rocs[0].bad.size(), 20u) << "only one condition has wrong matches";
}

// More hypotheses do not replace what was found before.
TEST(EntropyRoc, OfATrialTheFirstOfEachKindCounts) {
  StudyPlan few = WithTest(60), many = WithTest(120);
  for (StudyPlan* plan : {&few, &many}) plan->conditions.erase(plan->conditions.begin());
  int num_trials = 0;
  for (std::uint32_t trial = 0; trial < 40; ++trial) {
    const std::vector<EntropyRoc> first = Measure(few, {trial, trial + 1});
    if (first.empty() || first[0].population != "samples") continue;
    const std::vector<EntropyRoc> later = Measure(many, {trial, trial + 1});
    ASSERT_FALSE(later.empty());
    EXPECT_EQ(later[0].good, first[0].good) << trial;
    EXPECT_EQ(later[0].bad, first[0].bad) << trial;
    ++num_trials;
  }
  EXPECT_GE(num_trials, 5);
}

TEST(EntropyRoc, WithoutABadOneThereIsNoCurve) {
  Study study = WithTest(20).study;
  study.factors[0].levels = {"0"};
  for (const EntropyRoc& roc : Measure(MakePlan(study), {0, 10})) EXPECT_NE(roc.population, "samples");
}

}  // namespace
}  // namespace rcme
