#include "estimator/local_optimisation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/hypothesis.h"
#include "estimator/refinement/sampson_mle.h"
#include "estimator/solvers/five_point.h"
#include "stats/distributions.h"
#include "stats/moments.h"
#include "tests/test_support/numeric_jacobian.h"
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

// g of a match, and |J|, its gradient by the four coordinates, from F written out.
Eigen::Vector2d ConstraintByHand(const MotionProblem& problem, const RelativePose& pose,
                                 const Correspondence& match) {
  Eigen::Matrix3d cross;
  cross << 0, -pose.t.z(), pose.t.y(), pose.t.z(), 0, -pose.t.x(), -pose.t.y(), pose.t.x(), 0;
  const Eigen::Matrix3d F =
      problem.camera2.K().inverse().transpose() * cross * pose.R * problem.camera1.K().inverse();
  const Eigen::Vector3d x1 = match.x1_px.homogeneous(), x2 = match.x2_px.homogeneous();
  const Eigen::Vector3d line2 = F * x1, line1 = F.transpose() * x2;
  return {x2.dot(line2), std::hypot(line2.head<2>().norm(), line1.head<2>().norm())};
}

// The matches of Cov-RANSAC's test, Raguram, Frahm & Pollefeys 2009: the variance of g / |J| that the
// motion's covariance adds, by numeric differences.
std::vector<int> WidenedSupportByHand(const MotionProblem& problem, const RelativePose& pose,
                                      const Matrix5d& pose_cov) {
  std::vector<int> found;
  for (size_t i = 0; i < problem.matches.size(); ++i) {
    const Eigen::Vector2d at = ConstraintByHand(problem, pose, problem.matches[i]);
    const auto g = [&](const Eigen::VectorXd& move) {
      return Eigen::VectorXd::Constant(
          1, ConstraintByHand(problem, Retract(pose, Vector5d(move)), problem.matches[i])(0));
    };
    const Eigen::MatrixXd g_p = NumericJacobian(g, Eigen::VectorXd::Zero(5), 1e-4);
    const double variance = kSigmaPx * kSigmaPx + (g_p * pose_cov * g_p.transpose())(0, 0) / (at(1) * at(1));
    if (at(0) * at(0) / (at(1) * at(1)) <= kThreshold * variance) found.push_back(static_cast<int>(i));
  }
  return found;
}

// Refit by refit, written out: in 20 problems the same inliers in the end.
TEST(LocalOptimisation, UncertaintyNarrowsAsWrittenOutByHand) {
  int num_gained = 0;
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const MinimalStart start(trial);
    RelativePose pose = start.start.pose;
    Matrix5d pose_cov = start.pose_cov;
    std::vector<int> last;
    for (int refit = 0; refit < 5; ++refit) {
      const std::vector<int> support = WidenedSupportByHand(start.problem, pose, pose_cov);
      if (support == last) break;
      EXPECT_TRUE(refit > 0 || std::ranges::includes(support, start.start.inliers));
      const RefinedMotion motion = RefineBySampson(start.problem, support, pose, Loss::kSquared);
      if (!motion.converged) break;
      pose = motion.cam2_from_cam1;
      pose_cov = motion.pose_cov;
      last = support;
    }
    std::vector<int> expected = WithSupport(start.problem, pose, kThreshold).inliers;
    num_gained += expected.size() > start.start.inliers.size();
    if (expected.size() <= start.start.inliers.size()) expected = start.start.inliers;
    EXPECT_EQ(OptimiseByUncertainty(start.problem, start.start, start.pose_cov, kThreshold, 5).inliers,
              expected);
  }
  EXPECT_GE(num_gained, 15);
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
