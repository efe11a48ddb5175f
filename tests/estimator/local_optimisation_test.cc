#include "estimator/local_optimisation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "estimator/hypothesis.h"
#include "estimator/solvers/five_point.h"
#include "stats/distributions.h"
#include "stats/moments.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

constexpr double kSigmaPx = 0.5;
const double kThreshold = ChiSquareQuantile(1, 0.95);

// The model of five right matches with the most support, with its covariance; right matches come first.
struct MinimalStart {
  MotionProblem problem;
  Supported start, truth;
  Matrix5d pose_cov = Matrix5d::Zero();

  explicit MinimalStart(std::uint32_t trial) {
    RelativePose pose_true;
    problem = TwoCameraProblem(200, kSigmaPx, 0.0, trial, &pose_true);
    const Scene wrong = TwoCameraScene(100, trial);
    for (const Correspondence& match : ObserveTwoCameraScene(wrong, kSigmaPx, 1.0, trial + 1000).matches) {
      problem.matches.push_back(match);
    }
    truth = WithSupport(problem, pose_true, kThreshold);
    for (const Sample& sample : {Sample{0, 1, 2, 3, 4}, Sample{5, 6, 7, 8, 9}, Sample{10, 11, 12, 13, 14}}) {
      for (Hypothesis<FivePoint> hypothesis : InstantiateModels<FivePoint>(problem, sample)) {
        Supported supported = WithSupport(problem, hypothesis.pose, kThreshold);
        if (supported.inliers.size() <= start.inliers.size()) continue;
        start = std::move(supported);
        PropagateCovariance(problem, &hypothesis);
        pose_cov = hypothesis.pose_cov;
      }
    }
  }
};

double Share(const Supported& motion, const MinimalStart& start) {
  return static_cast<double>(motion.inliers.size()) / static_cast<double>(start.truth.inliers.size());
}

RandomStream Inner(std::uint32_t trial) { return RandomStream({.seed = 1, .trial = trial, .purpose = 2761}); }

// In 60 problems: either step brings back what the noise of five points cost. Nothing is ever lost.
TEST(LocalOptimisation, FindsTheSupportOfTheTruth) {
  Moments before, inner, uncertain;
  for (std::uint32_t trial = 0; trial < 60; ++trial) {
    const MinimalStart start(trial);
    RandomStream rng = Inner(trial);
    const Supported by_samples = OptimiseByInnerRansac(start.problem, start.start, kThreshold, {}, rng);
    const Supported by_covariance =
        OptimiseByUncertainty(start.problem, start.start, start.pose_cov, kThreshold, 5);
    EXPECT_GE(by_samples.inliers.size(), start.start.inliers.size());
    EXPECT_GE(by_covariance.inliers.size(), start.start.inliers.size());
    before.Add(Share(start.start, start));
    inner.Add(Share(by_samples, start));
    uncertain.Add(Share(by_covariance, start));
  }
  EXPECT_GT(inner.mean(), before.mean() + 0.2);
  EXPECT_GT(inner.mean(), 0.95);
  EXPECT_GT(uncertain.mean(), before.mean() + 0.1);
}

TEST(LocalOptimisation, WithoutEffortIsTheStart) {
  const MinimalStart start(0);
  RandomStream rng = Inner(0);
  const Supported none =
      OptimiseByInnerRansac(start.problem, start.start, kThreshold, {.num_samples = 0}, rng);
  EXPECT_EQ(none.inliers, start.start.inliers);
  EXPECT_EQ(none.pose.R, start.start.pose.R);
  const Supported unrefitted =
      OptimiseByUncertainty(start.problem, start.start, start.pose_cov, kThreshold, 0);
  EXPECT_EQ(unrefitted.inliers, start.start.inliers);
}

TEST(LocalOptimisation, OfTooFewInliersThereIsNone) {
  const MinimalStart start(0);
  RandomStream rng = Inner(0);
  const Supported few{start.start.pose, {1, 2, 3, 4, 5, 6, 7, 8}};
  EXPECT_EQ(OptimiseByInnerRansac(start.problem, few, kThreshold, {}, rng).inliers, few.inliers);
}

TEST(LocalOptimisation, SupportIsWhatLiesWithinTheThreshold) {
  const MinimalStart start(0);
  const Supported within = WithSupport(start.problem, start.start.pose, kThreshold),
                  wider = WithSupport(start.problem, start.start.pose, 4.0 * kThreshold);
  EXPECT_LT(within.inliers.size(), wider.inliers.size());
  EXPECT_TRUE(std::ranges::includes(wider.inliers, within.inliers));
}

}  // namespace
}  // namespace rcme
