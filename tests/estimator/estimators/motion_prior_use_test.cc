// What rcme_calibrated makes of a prior of the motion, and that the others do not look at it.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "estimator/calibrated/prior_check.h"
#include "estimator/estimator_registry.h"
#include "estimator/estimators/rcme_calibrated.h"
#include "simulator/scene_generator.h"
#include "stats/constants.h"
#include "stats/distributions.h"
#include "tests/test_support/coverage_count.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

MotionEstimate EstimateFrom(const MotionProblem& problem, std::uint32_t trial,
                            const CalibratedOptions& options = {}) {
  RandomStream rng({1, 0, trial, 4});
  return MakeRcmeCalibrated(options)->Estimate(problem, rng);
}

bool IsBeyondBounds(const MotionEstimate& estimate, const RelativePose& pose_true) {
  return RotationAngleBetween(estimate.cam2_from_cam1.R, pose_true.R) > 3.0 * kRadPerDeg ||
         AngleBetween(estimate.cam2_from_cam1.t, pose_true.t) > 15.0 * kRadPerDeg;
}

struct Measured {
  MotionProblem problem;
  RelativePose pose_true;
};

RotationPrior MeasureRotation(const RelativePose& truth, double sd_deg, std::uint32_t trial,
                              double bias_deg = 0.0) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 4131});
  const double sd = kRadPerDeg * sd_deg;
  Eigen::Vector3d noise;
  for (double& x : noise) x = sd * rng.Normal();
  const Eigen::Vector3d bias = kRadPerDeg * bias_deg * RandomDirection(rng);
  return {RotationFromVector(bias) * RotationFromVector(noise) * truth.R,
          sd * sd * Eigen::Matrix3d::Identity()};
}

Measured MakeMeasured(int num_matches, double outlier_ratio, double sd_deg, std::uint32_t trial,
                      double bias_deg = 0.0) {
  Measured made;
  made.problem = TwoCameraProblem(num_matches, 0.5, outlier_ratio, trial, &made.pose_true);
  made.problem.prior = MotionPrior{MeasureRotation(made.pose_true, sd_deg, trial, bias_deg)};
  return made;
}

void ExpectSameAnswer(const MotionEstimate& a, const MotionEstimate& b) {
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.cam2_from_cam1.R, b.cam2_from_cam1.R);
  EXPECT_EQ(a.cam2_from_cam1.t, b.cam2_from_cam1.t);
  EXPECT_EQ(a.pose_cov, b.pose_cov);
  EXPECT_EQ(a.inliers, b.inliers);
  EXPECT_TRUE(a.failure_probability == b.failure_probability ||
              (std::isnan(a.failure_probability) && std::isnan(b.failure_probability)));
}

// rcme_calibrated uses priors; the others give the same bytes with one.
TEST(MotionPriorUse, IsOfOneEstimator) {
  const Measured made = MakeMeasured(100, 0.2, 0.1, 1);
  MotionProblem without = made.problem;
  without.prior.reset();
  for (const EstimatorEntry& entry : EstimatorRegistry()) {
    SCOPED_TRACE(entry.name);
    RandomStream first({1, 0, 1, 4}), second({1, 0, 1, 4});
    const auto estimator = entry.make()->Make();
    const MotionEstimate with = estimator->Estimate(made.problem, first),
                         alone = estimator->Estimate(without, second);
    EXPECT_EQ(alone.prior, PriorUse::kNone);
    if (entry.name == "rcme_calibrated") {
      EXPECT_EQ(with.prior, PriorUse::kUsed);
      EXPECT_NE(with.cam2_from_cam1.R, alone.cam2_from_cam1.R);
      EXPECT_EQ(with.probability_domain, ProbabilityDomain::kExtrapolated);
    } else {
      EXPECT_EQ(with.prior, PriorUse::kNone);
      ExpectSameAnswer(with, alone);
    }
  }
}

// The prior is exact, its standard deviation a hundredth of that of the matches. No error of the calibration
// turns the rotation that it fixes.
TEST(MotionPriorUse, AnExactRotationIsKept) {
  for (std::uint32_t trial = 0; trial < 10; ++trial) {
    Measured made = MakeMeasured(100, 0.3, 1e-3, trial);
    made.problem.prior->rotation->R = made.pose_true.R;
    CalibratedOptions with_errors;
    with_errors.unstated_errors = 0.01;
    const MotionEstimate e = EstimateFrom(made.problem, trial, with_errors);
    ASSERT_EQ(e.status, MotionStatus::kOk);
    EXPECT_EQ(e.prior, PriorUse::kUsed);
    EXPECT_LT(RotationAngleBetween(e.cam2_from_cam1.R, made.pose_true.R), 3e-3 * kRadPerDeg) << trial;
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(std::sqrt(e.pose_cov(k, k)) * kDegPerRad, 1e-3, 1e-4);
    EXPECT_FALSE(IsBeyondBounds(e, made.pose_true));
  }
}

// A principal point that is 10 px off turns the motion of the matches away from a right rotation. If errors
// of the calibration are counted, the matches do not contradict it.
TEST(MotionPriorUse, ARightRotationIsKeptThoughTheCalibrationIsWrong) {
  constexpr int kTrials = 12;
  CalibratedOptions without, counting;
  without.unstated_errors = 0.0;
  counting.unstated_errors = 1.0;
  int num_without = 0, num_counting = 0;
  for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
    Measured made = MakeMeasured(300, 0.3, 0.01, trial);
    made.problem.camera1.cx += 10.0;
    made.problem.camera1.cy -= 10.0;
    num_without += EstimateFrom(made.problem, trial, without).prior == PriorUse::kContradicted;
    num_counting += EstimateFrom(made.problem, trial, counting).prior == PriorUse::kContradicted;
  }
  EXPECT_GE(num_without, 6);
  EXPECT_LE(num_counting, 1);
}

// A direction 20 or 100 standard deviations off, with a right calibration, that contradicts the matches if no
// errors of it are counted. By the matches errors are hardly probable; where they are not quite impossible,
// the covariance counts them as the prior makes them probable.
TEST(MotionPriorUse, AWrongDirectionIsNotMadeRightByErrorsOfTheCalibration) {
  constexpr int kTrials = 24;
  CalibratedOptions without;
  without.unstated_errors = 0.0;
  int num_wrong = 0, num_noticed = 0;
  for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
    Measured made = MakeMeasured(300, 0.3, 1.0, trial);
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 2854});
    const double bias_deg = trial % 2 == 0 ? 1.0 : 5.0;
    const Eigen::Vector3d axis = made.pose_true.t.cross(RandomDirection(rng)).normalized();
    made.problem.prior = MotionPrior{};
    made.problem.prior->direction = {RotationFromVector(kRadPerDeg * bias_deg * axis) * made.pose_true.t,
                                     kRadPerDeg * 0.05};
    if (EstimateFrom(made.problem, trial, without).prior != PriorUse::kContradicted) continue;
    ++num_wrong;
    const MotionEstimate e = EstimateFrom(made.problem, trial);
    ASSERT_EQ(e.status, MotionStatus::kOk);
    num_noticed += e.prior == PriorUse::kContradicted;
    const Vector5d error = LocalCoordinates(e.cam2_from_cam1, made.pose_true);
    EXPECT_LT(error.dot(e.pose_cov.llt().solve(error)), 30.0)
        << trial << ", errors with probability " << e.calibration_error_probability;
  }
  EXPECT_GE(num_wrong, 12);
  EXPECT_GE(num_noticed, 0.8 * num_wrong);
}

// A prior that says next to nothing leaves the answer where it is: of standard deviations of a million
// radians the information is 1e-12 of theirs.
TEST(MotionPriorUse, AWidePriorChangesNothing) {
  for (std::uint32_t trial = 0; trial < 10; ++trial) {
    Measured made = MakeMeasured(150, 0.3, 1.0, trial);
    made.problem.prior->rotation->cov = 1e12 * Eigen::Matrix3d::Identity();
    made.problem.prior->gravity = {Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitX(), 1e6, 1e6};
    made.problem.prior->direction = {Eigen::Vector3d::UnitX(), 1e6};
    const MotionEstimate with = EstimateFrom(made.problem, trial);
    made.problem.prior.reset();
    const MotionEstimate alone = EstimateFrom(made.problem, trial);
    ASSERT_EQ(with.status, MotionStatus::kOk);
    const Vector5d away = LocalCoordinates(alone.cam2_from_cam1, with.cam2_from_cam1);
    EXPECT_LT(away.dot(alone.pose_cov.llt().solve(away)), 1e-4) << trial;
    EXPECT_NEAR(with.pose_cov.trace() / alone.pose_cov.trace(), 1.0, 1e-2) << trial;
    EXPECT_NEAR(with.failure_probability, alone.failure_probability, 1e-3) << trial;
  }
}

// 300 trials with 60 matches, the rotation known to about what these say of it. Coverage of the 95 % region:
// nominal is .94 to .99, as for the covariance of matches alone; a false alarm has probability 1e-4.
TEST(MotionPriorUse, TheCovarianceCoversTheTruth) {
  const double bound = ChiSquareQuantile(5, 0.95);
  CoverageCount covered;
  double with_prior = 0.0, without = 0.0;
  for (std::uint32_t trial = 0; trial < 300; ++trial) {
    Measured made = MakeMeasured(60, 0.2, 0.1, 2000 + trial);
    const MotionEstimate e = EstimateFrom(made.problem, trial);
    made.problem.prior.reset();
    const MotionEstimate alone = EstimateFrom(made.problem, trial);
    if (e.status != MotionStatus::kOk || IsBeyondBounds(e, made.pose_true) ||
        IsBeyondBounds(alone, made.pose_true))
      continue;
    const Vector5d error = LocalCoordinates(e.cam2_from_cam1, made.pose_true);
    covered.Add(error.dot(e.pose_cov.llt().solve(error)) <= bound);
    with_prior += error.head<3>().squaredNorm();
    without += LocalCoordinates(alone.cam2_from_cam1, made.pose_true).head<3>().squaredNorm();
  }
  EXPECT_GT(covered.n(), 280);
  EXPECT_LT(covered.interval().lower, 0.99) << covered;
  EXPECT_GT(covered.interval().upper, 0.94) << covered;
  EXPECT_LT(with_prior, 0.7 * without);
}

// Where the matches decide, a prior ten standard deviations off is noticed, and the answer is that of the
// matches alone, number for number.
TEST(MotionPriorUse, AWrongPriorIsNoticed) {
  int num_noticed = 0;
  constexpr int kTrials = 60;
  for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
    Measured made = MakeMeasured(150, 0.3, 0.5, trial, 5.0);
    const MotionEstimate e = EstimateFrom(made.problem, trial);
    if (e.prior != PriorUse::kContradicted) continue;
    ++num_noticed;
    EXPECT_LT(e.prior_p_value, kPriorLevel);
    EXPECT_NE(e.message.find("contradicts"), std::string::npos);
    made.problem.prior.reset();
    ExpectSameAnswer(e, EstimateFrom(made.problem, trial));
  }
  EXPECT_GE(num_noticed, kTrials - 2);
}

// A right rotation and a gravity 5 deg off: it is not the matches that they are in conflict with.
TEST(MotionPriorUse, ARotationAndGravityThatContradictEachOtherAreNamed) {
  Measured made = MakeMeasured(150, 0.3, 0.1, 1);
  const Eigen::Vector3d down1 = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d down2 = RotationFromVector({5.0 * kRadPerDeg, 0.0, 0.0}) * made.pose_true.R * down1;
  made.problem.prior->gravity = GravityPrior{down1, down2, 0.1 * kRadPerDeg, 0.1 * kRadPerDeg};
  const MotionEstimate e = EstimateFrom(made.problem, 1);
  EXPECT_EQ(e.prior, PriorUse::kContradicted);
  EXPECT_NE(e.message.find("rotation and gravity contradict each other"), std::string::npos) << e.message;
}

// Right priors: at the level of 1e-3 more than six of 1,000 have probability 1e-4 (Poisson). A covariance of
// the matches left out of the test would make it twenty and more with a standard deviation as small as
// theirs.
TEST(MotionPriorUse, ARightPriorIsSeldomContradicted) {
  int num_false = 0, num_small = 0;
  constexpr int kTrials = 1000;
  for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
    const Measured made = MakeMeasured(80, 0.2, 0.1, 5000 + trial);
    const MotionEstimate e = EstimateFrom(made.problem, trial);
    num_false += e.prior == PriorUse::kContradicted;
    num_small += e.prior_p_value < 0.05;
  }
  EXPECT_LE(num_false, 6);
  EXPECT_LE(num_small, 85);  // of 50: five standard deviations
  EXPECT_GE(num_small, 5);   // the covariance of the matches is a little wide
}

// Gravity and the direction of travel, each alone: less error along what they see.
TEST(MotionPriorUse, GravityAndDirectionMakeTheAnswerBetter) {
  double gravity_error = 0.0, direction_error = 0.0, rotation_alone = 0.0, direction_alone = 0.0;
  for (std::uint32_t trial = 0; trial < 60; ++trial) {
    RelativePose truth;
    MotionProblem problem = TwoCameraProblem(40, 1.0, 0.2, 8000 + trial, &truth);
    const MotionEstimate alone = EstimateFrom(problem, trial);
    if (alone.status != MotionStatus::kOk || IsBeyondBounds(alone, truth)) continue;
    rotation_alone += (alone.cam2_from_cam1.R * Eigen::Vector3d::UnitY() - truth.R * Eigen::Vector3d::UnitY())
                          .squaredNorm();
    direction_alone += std::pow(AngleBetween(alone.cam2_from_cam1.t, truth.t), 2);
    const double sd = 0.05 * kRadPerDeg;
    problem.prior = MotionPrior{
        {}, GravityPrior{Eigen::Vector3d::UnitY(), truth.R * Eigen::Vector3d::UnitY(), sd, sd}, {}};
    const MotionEstimate with_gravity = EstimateFrom(problem, trial);
    gravity_error +=
        (with_gravity.cam2_from_cam1.R * Eigen::Vector3d::UnitY() - truth.R * Eigen::Vector3d::UnitY())
            .squaredNorm();
    problem.prior = MotionPrior{{}, {}, DirectionPrior{truth.t, 0.2 * kRadPerDeg}};
    const MotionEstimate with_direction = EstimateFrom(problem, trial);
    direction_error += std::pow(AngleBetween(with_direction.cam2_from_cam1.t, truth.t), 2);
    EXPECT_EQ(with_gravity.prior, PriorUse::kUsed);
    EXPECT_EQ(with_direction.prior, PriorUse::kUsed);
  }
  EXPECT_LT(gravity_error, 0.3 * rotation_alone);
  EXPECT_LT(direction_error, 0.3 * direction_alone);
}

// 87 % wrong and at most 2000 samples of five matches, of which one is all right with probability .07. Over
// 300 trials half of the answers are wrong without gravity, and 6 % with it; 43 % if it leads to no samples
// of three. At these rates 100 trials miss a bound with a probability below 1e-4.
TEST(MotionPriorUse, GravityFindsTheMotionAmongManyWrongMatches) {
  CalibratedOptions options;
  options.max_samples = 2000;
  CoverageCount wrong_alone, wrong;
  for (std::uint32_t trial = 0; trial < 100; ++trial) {
    RelativePose truth;
    MotionProblem problem = TwoCameraProblem(200, 0.5, 0.87, 9000 + trial, &truth);
    wrong_alone.Add(IsBeyondBounds(EstimateFrom(problem, trial, options), truth));
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 4136});
    const double sd = 0.5 * kRadPerDeg;
    const auto measure = [&](const Eigen::Vector3d& down) {
      const Eigen::Vector2d noise(rng.Normal(), rng.Normal());
      return (down + sd * DirectionBasis(down) * noise).normalized();
    };
    const Eigen::Vector3d down1 = Eigen::Vector3d::UnitY(), down2 = truth.R * down1;
    problem.prior = MotionPrior{{}, GravityPrior{measure(down1), measure(down2), sd, sd}, {}};
    wrong.Add(IsBeyondBounds(EstimateFrom(problem, trial, options), truth));
  }
  EXPECT_GT(wrong_alone.rate(), 0.3) << wrong_alone;
  EXPECT_LT(wrong.rate(), 0.2) << wrong;
}

TEST(MotionPriorUse, AnImpossiblePriorIsRefused) {
  Measured made = MakeMeasured(50, 0.2, 0.1, 1);
  made.problem.prior->rotation->R *= 1.01;
  const MotionEstimate e = EstimateFrom(made.problem, 1);
  EXPECT_EQ(e.status, MotionStatus::kInvalidInput);
  EXPECT_NE(e.message.find("prior"), std::string::npos);
}

// Nearly all points on a plane, travel along the axis: two motions explain the matches, and a rotation known
// to a degree tells which is the camera's, even where usual motions are not preferred. Without either a part
// of the answers is wrong.
TEST(MotionPriorUse, ChoosesBetweenTheMotionsOfAPlane) {
  SceneGenerator scenes("plane_and_parallax", "", "forward");
  for (const auto& [key, value] :
       {std::pair{"num_matches", "150"}, {"off_plane_share", "0"}, {"baseline_m", "1"}})
    FindParameter(scenes.Parameters(), key).SetFromText(value);
  CalibratedOptions options;
  options.leave_out = CalibratedStep::kUsualMotions;
  int num_wrong = 0, num_wrong_alone = 0;
  for (std::uint32_t trial = 0; trial < 60; ++trial) {
    RandomStream scene_rng({.seed = 1, .trial = trial, .purpose = 4135});
    const Scene scene = scenes.Generate(scene_rng);
    const RelativePose& truth = scene.cam2_from_cam1_true;
    MotionProblem problem{ObserveTwoCameraScene(scene, 1.0, 0.2, trial).matches, scene.camera1, scene.camera2,
                          1.0};
    num_wrong_alone += IsBeyondBounds(EstimateFrom(problem, trial, options), truth);
    problem.prior = MotionPrior{MeasureRotation(truth, 1.0, trial)};
    num_wrong += IsBeyondBounds(EstimateFrom(problem, trial, options), truth);
  }
  EXPECT_GE(num_wrong_alone, 8);
  EXPECT_LE(num_wrong, num_wrong_alone / 3);
}

}  // namespace
}  // namespace rcme
