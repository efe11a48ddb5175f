// The quantities of one pair whose matches lie at known distances from the answer.
#include "experiments/real/truth_free/twin_quantities.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "estimator/geometry/sampson.h"
#include "experiments/real/truth_free/twin.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

// Gives any problem the same answer.
class Fixed : public MotionEstimator {
 public:
  explicit Fixed(const MotionEstimate& answer) : answer_(answer) {}
  MotionEstimate Estimate(const MotionProblem& problem, RandomStream&) const override {
    MotionEstimate answer = answer_;
    answer.inliers.clear();
    for (int i = 0; i < static_cast<int>(problem.matches.size()); ++i) answer.inliers.push_back(i);
    return answer;
  }

 private:
  MotionEstimate answer_;
};

struct Case {
  TrialData trial;
  MotionEstimate estimate;
};
// 50 matches, those given off by so many sigma of 0.4 px and accepted, the others at 3 (near, not accepted)
// or 30 (not near).
Case MakeCase(const std::vector<double>& accepted_sigmas, size_t num_near) {
  Case made;
  RelativePose pose;
  MotionProblem& problem = made.trial.problem;
  problem = TwoCameraProblem(50, 1e-9, 0.0, 1, &pose);
  const Eigen::Matrix3d F = ComputeFundamental(problem, pose);
  for (size_t i = 0; i < 50; ++i) {
    const bool is_accepted = i < accepted_sigmas.size();
    const double off_sigmas = is_accepted                             ? accepted_sigmas[i]
                              : i < accepted_sigmas.size() + num_near ? 3.0
                                                                      : 30.0;
    Correspondence& match = problem.matches[i];
    const Eigen::Vector4d u = EvaluateConstraint(F, match).gradient.normalized();
    match.x1_px += 0.4 * off_sigmas * u.head<2>();
    match.x2_px += 0.4 * off_sigmas * u.tail<2>();
    if (is_accepted) made.estimate.inliers.push_back(static_cast<int>(i));
  }
  made.estimate.status = MotionStatus::kOk;
  made.estimate.cam2_from_cam1 = pose;
  made.estimate.sigma_estimated_px = 0.4;
  made.estimate.failure_probability = 0.125;
  const Vector5d variances(1e-6, 2e-6, 6e-6, 3e-6, 13e-6);
  made.estimate.pose_cov = variances.asDiagonal();
  return made;
}

Values ComputeValues(const Case& c) {
  return ComputeValues(c.trial, c.estimate, Fixed(c.estimate), {1, 2, 0, 0});
}

TEST(ComputeValues, CountsMatchesByTheirDistance) {
  std::vector<double> sigmas(20, 0.5);
  for (size_t i = 0; i < 3; ++i) sigmas[i] = 1.5;  // within two sigma
  for (size_t i = 3; i < 8; ++i) sigmas[i] = 2.2;  // beyond
  const Values values = ComputeValues(MakeCase(sigmas, 5));
  EXPECT_EQ(values[kRefusal], std::vector<double>{0.0});
  EXPECT_EQ(values[kSigma], std::vector<double>{0.4});
  EXPECT_EQ(values[kStatedFailure], std::vector<double>{0.125});
  EXPECT_EQ(values[kTailShare], std::vector<double>{5.0 / 20.0});
  EXPECT_EQ(values[kAcceptedShare], std::vector<double>{20.0 / 50.0});
  EXPECT_EQ(values[kInlierTest], std::vector<double>{20.0 / 25.0});  // of those within four sigma
  EXPECT_TRUE(values[kFailure].empty());                             // nobody knows the motion
}

// Logarithms of standard deviations in degrees: roots of the sums of variances.
TEST(ComputeValues, TakesStandardDeviations) {
  const Values values = ComputeValues(MakeCase(std::vector<double>(40, 0.5), 0));
  ASSERT_EQ(values[kRotationSd].size(), 1u);
  EXPECT_NEAR(values[kRotationSd][0], std::log(3e-3 * 180.0 / std::numbers::pi), 1e-9);
  EXPECT_NEAR(values[kDirectionSd][0], std::log(4e-3 * 180.0 / std::numbers::pi), 1e-9);
}

// Halves that are answered alike lie within each other's region, answers far from each other do not.
TEST(ComputeValues, ComparesHalves) {
  const Case c = MakeCase(std::vector<double>(50, 0.5), 0);
  const Values alike = ComputeValues(c);
  EXPECT_EQ(alike[kSpatialHalves], (std::vector<double>{1.0, 1.0}));
  EXPECT_EQ(alike[kRandomHalves], (std::vector<double>{1.0, 1.0}));
  // Every other call is turned by ten standard deviations.
  class Turning : public MotionEstimator {
   public:
    explicit Turning(const Case& c) : c_(c) {}
    MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
      MotionEstimate answer = Fixed(c_.estimate).Estimate(problem, rng);
      if (++num_calls_ % 2 == 0)
        answer.cam2_from_cam1.R = RotationFromVector({0.02, 0.0, 0.0}) * answer.cam2_from_cam1.R;
      return answer;
    }

   private:
    const Case& c_;
    mutable int num_calls_ = 0;
  };
  const Values apart = ComputeValues(c.trial, c.estimate, Turning(c), {1, 2, 0, 0});
  EXPECT_EQ(apart[kSpatialHalves], (std::vector<double>{0.0, 0.0}));
  EXPECT_EQ(apart[kRandomHalves], (std::vector<double>{0.0, 0.0}));
}

TEST(ComputeValues, OfARefusalIsTheRefusal) {
  Case c = MakeCase(std::vector<double>(40, 0.5), 0);
  c.estimate.status = MotionStatus::kNoCandidate;
  c.trial.truth.cam2_from_cam1_true = c.estimate.cam2_from_cam1;
  const Values values = ComputeValues(c);
  EXPECT_EQ(values[kRefusal], std::vector<double>{1.0});
  EXPECT_EQ(values[kFailure], std::vector<double>{0.0});
  EXPECT_TRUE(values[kSigma].empty());
}

}  // namespace
}  // namespace rcme
