// An estimator of a user's own that now and then answers "ok" with what is no motion or no covariance: every
// table and count has it as a failure, and coverage as a miss. Its honest twin has none of it.
#include <gtest/gtest.h>

#include <limits>

#include "experiments/audit/claims/call_estimator.h"
#include "experiments/run/run_until.h"
#include "experiments/statistics/compare.h"
#include "experiments/statistics/summarize.h"
#include "experiments/tuning/tune.h"
#include "stats/constants.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"
#include "tests/test_support/test_estimators.h"

namespace rcme {
namespace {

// Estimator 0 is rcme, estimator 1 the same with the fault in a tenth of its motions; no wrong matches.
StudyPlan PlanWithFault(const FaultyEstimator::Plant& plant, int num_trials) {
  Study study = SmallStudy();
  study.trials = num_trials;
  study.factors.clear();
  StudyPlan plan = MakePlan(study);
  plan.estimators[0] = std::make_shared<FaultyEstimator>(plant, 0.0);
  plan.estimators[1] = std::make_shared<FaultyEstimator>(plant, 0.1);
  return plan;
}

struct Totals {
  int num_failures = 0, num_refusals = 0, num_invalid = 0;
};

std::vector<Totals> CountTotals(const StudyPlan& plan, const ResultStore& store) {
  std::vector<Totals> totals(plan.estimators.size());
  store.ForEachRecord([&](const TrialRecord& record) {
    totals[record.estimator].num_failures += HasFailed(record, plan.study.failure);
    totals[record.estimator].num_refusals += HasRefused(record);
    totals[record.estimator].num_invalid += IsInvalid(record);
  });
  return totals;
}

const SummaryRow& FindRow(const Summary& summary, const std::string& estimator, const std::string& quantity) {
  for (const SummaryRow& row : summary.rows) {
    if (row.estimator == estimator && row.quantity == quantity) return row;
  }
  throw std::out_of_range(quantity);
}

// One in ten of 200 trials: the twin has none of them.
TEST(InvalidAnswers, AreFailuresInSummaryComparisonAndVerification) {
  const StudyPlan plan =
      PlanWithFault([](MotionEstimate& estimate) { estimate.cam2_from_cam1.R(0, 0) = kNaN; }, 200);
  const TempFolder folder;
  ResultStore store = ResultStore::OpenForRun(folder.Path("run.sqlite"), plan);
  RunStudy(plan, 2, &store);
  const std::vector<Totals> totals = CountTotals(plan, store);
  EXPECT_EQ(totals[0].num_invalid, 0);
  ASSERT_GE(totals[1].num_invalid, 8);
  EXPECT_EQ(totals[1].num_failures, totals[0].num_failures + totals[1].num_invalid);
  EXPECT_EQ(totals[1].num_refusals, totals[0].num_refusals);

  const Summary summary = Summarize(store, false);
  const auto count = [&](const char* quantity) {
    const SummaryRow& row = FindRow(summary, "ours", quantity);
    EXPECT_EQ(row.n, 200) << quantity;
    return static_cast<int>(std::lround(row.value * 200));
  };
  EXPECT_EQ(count("failure"), totals[1].num_failures);
  EXPECT_EQ(count("invalid_motion"), totals[1].num_invalid);
  EXPECT_EQ(count("success"), 200 - totals[1].num_failures - totals[1].num_refusals);
  const SummaryRow& twin = FindRow(summary, "standard", "nees_coverage");
  const SummaryRow& faulty = FindRow(summary, "ours", "nees_coverage");
  EXPECT_EQ(faulty.n, twin.n);
  EXPECT_LT(faulty.value, twin.value - 0.02);

  for (const ComparisonRow& row : Compare(store, "standard").rows) {
    if (row.event == "failure") {
      EXPECT_LT(row.p_value, 0.01) << "distinguished from its honest twin";
    }
    if (row.event == "refusal") {
      EXPECT_EQ(row.counts.RiskDifference(), 0.0);
    }
  }
  const std::vector<VerifiedEstimator> verified = VerifyEstimators(plan, {0, 200});
  EXPECT_EQ(verified[1].failure.errors, totals[1].num_failures);
  EXPECT_EQ(verified[1].refusal.errors, totals[1].num_refusals);
  EXPECT_EQ(verified[1].failure_or_refusal.errors, totals[1].num_failures + totals[1].num_refusals);
}

TEST(InvalidAnswers, AreCountedByAStoppingRule) {
  const StudyPlan plan =
      PlanWithFault([](MotionEstimate& estimate) { estimate.cam2_from_cam1.t.setZero(); }, 100);
  const TempFolder folder;
  ResultStore store = ResultStore::OpenForRun(folder.Path("run.sqlite"), plan);
  UntilOptions options;
  options.target = PrecisionTarget::Parse("ci=0.9");
  options.num_threads = 2;
  const std::vector<CellPrecision> cells = RunUntil(plan, options, &store);
  const std::vector<Totals> totals = CountTotals(plan, store);
  ASSERT_GE(totals[1].num_invalid, 3);
  EXPECT_EQ(cells[0].estimator, 1u) << "the one with the wider interval";
  EXPECT_DOUBLE_EQ(cells[0].rate, totals[1].num_failures / 100.0);
}

// A trial of the claim about reported covariances: returned, failed, and not covered; never missing.
TEST(InvalidAnswers, DoNotCoverInTheAudit) {
  const CaseMaker cases = SimulatedCases({{"num_matches", "60"}});
  const std::vector<FaultyEstimator::Plant> plants = {
      [](MotionEstimate& e) { e.cam2_from_cam1.R(0, 0) = kNaN; },
      [](MotionEstimate& e) { e.cam2_from_cam1.R *= -1.0; },
      [](MotionEstimate& e) { e.cam2_from_cam1.t.setZero(); },
      [](MotionEstimate& e) { e.pose_cov(0, 0) = kNaN; },
      [](MotionEstimate& e) { e.pose_cov(0, 4) += 1.0; },
      [](MotionEstimate& e) { e.pose_cov *= -1.0; }};
  const Case made = cases({1, 0, 0, 0});
  const Outcome sound = ReportedCovarianceStatistic(FaultyEstimator([](MotionEstimate&) {}), made);
  ASSERT_TRUE(std::isfinite(sound[0]));
  EXPECT_EQ(sound[1], 1.0);
  EXPECT_EQ(sound[2], 0.0);
  for (const FaultyEstimator::Plant& plant : plants) {
    const Outcome outcome = ReportedCovarianceStatistic(FaultyEstimator(plant), made);
    EXPECT_EQ(outcome[0], std::numeric_limits<double>::infinity());
    EXPECT_EQ(outcome[1], 1.0);
    EXPECT_EQ(outcome[2], 1.0);
  }
}

}  // namespace
}  // namespace rcme
