// The methods of the literature that share the loop: msac, mlesac, lo_ransac, cov_ransac, m_estimator.
#include <gtest/gtest.h>

#include "estimator/estimators/robust_score.h"
#include "estimator/loop_inspection.h"
#include "estimator/solvers/solver_list.h"
#include "stats/moments.h"
#include "tests/test_support/option_checks.h"

namespace rcme {
namespace {

MotionEstimate Ask(const std::string& name, const Settings& options, const MotionProblem& problem,
                   std::uint32_t trial = 0) {
  RandomStream rng({1, 0, trial, 4});
  return MakeEstimator(name, options)->Estimate(problem, rng);
}

const char* const kNames[] = {"msac", "mlesac", "lo_ransac", "cov_ransac", "m_estimator"};

// 20 problems each, 30 % of 200 matches wrong: with five points nearly none fails (sample of right matches:
// 0.17), and its error is that of the maximum likelihood, far below a degree.
TEST(RansacVariants, FindTheMotionWithEitherSolver) {
  for (const char* name : kNames) {
    for (const char* solver : {"five_point", "eight_point"}) {
      int num_right = 0;
      for (std::uint32_t trial = 0; trial < 20; ++trial) {
        RelativePose pose_true;
        const MotionProblem problem = TwoCameraProblem(200, 0.5, 0.3, trial, &pose_true);
        const MotionEstimate estimate = Ask(name, {{"solver", solver}}, problem, trial);
        if (estimate.status != MotionStatus::kOk) continue;
        EXPECT_TRUE(estimate.pose_cov.allFinite());
        num_right += RotationAngleBetween(estimate.cam2_from_cam1.R, pose_true.R) < 0.02 &&
                     estimate.cam2_from_cam1.t.dot(pose_true.t) > 0.9;
      }
      EXPECT_GE(num_right, 17) << name << ", " << solver;
    }
  }
}

// Without their step they are RANSAC: the same samples, the same winner, the same answer.
TEST(RansacVariants, WithoutTheirStepAreStandard) {
  for (const MotionProblem& problem : Problems()) {
    const auto standard = ListEstimateNumbers(Ask("standard", {{"implementation", "reference"}}, problem));
    EXPECT_EQ(ListEstimateNumbers(Ask("lo_ransac", {{"inner_samples", "0"}}, problem)), standard);
    EXPECT_EQ(ListEstimateNumbers(Ask("cov_ransac", {{"progressive_refits", "0"}}, problem)), standard);
  }
}

// The optimised motion has more support than that of any sample.
TEST(RansacVariants, OptimisedMotionsHaveMoreSupport) {
  Moments standard, lo, cov;
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const MotionProblem problem = TwoCameraProblem(200, 0.5, 0.3, trial);
    const Settings solver = {{"solver", "five_point"}};
    standard.Add(Ask("standard", solver, problem, trial).num_support);
    lo.Add(Ask("lo_ransac", solver, problem, trial).num_support);
    cov.Add(Ask("cov_ransac", solver, problem, trial).num_support);
  }
  EXPECT_GT(lo.mean(), standard.mean() + 5.0);
  EXPECT_GT(cov.mean(), standard.mean() + 2.0);
}

// The winner is the hypothesis of the least cost among those with enough inliers, whatever their number.
TEST(RansacVariants, TheLeastCostWins) {
  RansacOptions options;
  options.solver = MinimalSolver::kFivePoint;
  for (const auto make : {MakeMsac, MakeMlesac}) {
    const std::unique_ptr<MotionEstimator> estimator = make(options);
    const LoopInspection* const inspection = FindInspection(*estimator);
    const MotionProblem problem = TwoCameraProblem(100, 0.5, 0.3, 0);
    RandomStream rng({1, 0, 0, 4});
    const HypothesisTrace trace = inspection->Trace(problem, rng);
    const LoopResult loop = inspection->Decide(trace);
    ASSERT_TRUE(loop.winner.has_value());
    int most = 0;
    for (const ScoredHypothesis& h : trace.hypotheses) most = std::max(most, h.score.num_inliers);
    for (const ScoredHypothesis& h : trace.hypotheses) {
      if (h.proposal.verdict != SampleVerdict::kConsistent || h.score.num_inliers < 0.5 * most) continue;
      EXPECT_GE(h.score.negative_log_likelihood, loop.winner->score.negative_log_likelihood);
    }
    Refinements refinements;
    RandomStream again({1, 0, 0, 4});
    EXPECT_EQ(ListEstimateNumbers(inspection->Finish(problem, loop, &refinements)),
              ListEstimateNumbers(estimator->Estimate(problem, again)));
  }
}

// Huber's loss is drawn by far matches with high leverage, so that it may have no optimum near the start.
TEST(RansacVariants, TheMEstimatorTakesEitherLoss) {
  for (std::uint32_t trial = 0; trial < 10; ++trial) {
    const MotionProblem problem = TwoCameraProblem(200, 0.5, 0.1, trial);
    const MotionEstimate huber = Ask("m_estimator", {{"loss", "huber"}}, problem, trial),
                         tukey = Ask("m_estimator", {{"loss", "tukey"}}, problem, trial);
    EXPECT_EQ(tukey.status, MotionStatus::kOk);
    EXPECT_TRUE(huber.status == MotionStatus::kOk || huber.status == MotionStatus::kRefinementDiverged);
    EXPECT_FALSE(huber.message.empty());
    EXPECT_NE(ListEstimateNumbers(huber), ListEstimateNumbers(tukey));
  }
}

}  // namespace
}  // namespace rcme
