#include "estimator/refinement/m_estimation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "estimator/refinement/sampson_equations.h"
#include "estimator/refinement/sampson_mle.h"
#include "stats/consistency.h"
#include "stats/distributions.h"
#include "stats/moments.h"
#include "tests/test_support/coverage_count.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

constexpr MEstimation kHuber{RobustLoss::kHuber, 0.0}, kTukey{RobustLoss::kTukey, 0.0};

TEST(RobustLoss, IsWhatTheFormulasGiveByHand) {
  const auto expect = [](const RobustTerms& terms, double rho, double psi, double weight, double slope) {
    EXPECT_NEAR(terms.rho, rho, 1e-12);
    EXPECT_NEAR(terms.psi, psi, 1e-12);
    EXPECT_NEAR(terms.weight, weight, 1e-12);
    EXPECT_NEAR(terms.slope, slope, 1e-12);
  };
  expect(EvaluateRobustLoss({RobustLoss::kHuber, 2.0}, 1.0), 0.5, 1.0, 1.0, 1.0);
  expect(EvaluateRobustLoss({RobustLoss::kHuber, 2.0}, -5.0), 8.0, -2.0, 0.4, 0.0);
  // u = 1/4: rho = 16/6 (1 - 27/64), psi = 2 9/16, slope = 3/4 (1 - 5/4).
  expect(EvaluateRobustLoss({RobustLoss::kTukey, 4.0}, 2.0), 37.0 / 24.0, 1.125, 0.5625, -0.1875);
  expect(EvaluateRobustLoss({RobustLoss::kTukey, 4.0}, 5.0), 16.0 / 6.0, 0.0, 0.0, 0.0);
}

TEST(RobustLoss, PsiAndItsSlopeAreDerivatives) {
  constexpr double kStep = 1e-5;
  for (const MEstimation& loss : {kHuber, kTukey}) {
    for (const double r : {-6.0, -2.0, -0.5, 0.1, 1.0, 1.3, 4.0, 5.0}) {
      const RobustTerms below = EvaluateRobustLoss(loss, r - kStep), at = EvaluateRobustLoss(loss, r),
                        above = EvaluateRobustLoss(loss, r + kStep);
      EXPECT_NEAR((above.rho - below.rho) / (2.0 * kStep), at.psi, 1e-8) << r;
      EXPECT_NEAR((above.psi - below.psi) / (2.0 * kStep), at.slope, 1e-8) << r;
      EXPECT_NEAR(at.weight * r, at.psi, 1e-12) << r;
    }
  }
}

// (E psi')^2 / E psi^2 of a standard normal is the efficiency.
TEST(RobustLoss, DefaultsAreOf95PercentEfficiency) {
  for (const MEstimation& loss : {kHuber, kTukey}) {
    double slope = 0.0, square = 0.0;
    for (double r = -10.0; r <= 10.0; r += 1e-3) {
      const RobustTerms terms = EvaluateRobustLoss(loss, r);
      const double density = std::exp(-0.5 * r * r) / std::sqrt(2.0 * std::numbers::pi) * 1e-3;
      slope += terms.slope * density;
      square += terms.psi * terms.psi * density;
    }
    EXPECT_NEAR(slope * slope / square, 0.95, 0.0005);
  }
}

RefinedMotion FitTrial(const MEstimation& options, double outlier_ratio, std::uint32_t trial,
                       RelativePose* pose_true) {
  const MotionProblem problem = TwoCameraProblem(200, 0.5, outlier_ratio, trial, pose_true);
  return RefineByMEstimation(problem, *pose_true, options);
}

// The reported covariance against the truth. 300 problems; at the true rate the test fails with probability
// 1e-4, and a variance that is 25 % off gives a rate of 0.905 or 0.975.
TEST(MEstimation, CovarianceCoversWhereNothingIsWrong) {
  for (const MEstimation& options : {kHuber, kTukey}) {
    CoverageCount covered;
    for (std::uint32_t trial = 0; trial < 300; ++trial) {
      RelativePose pose_true;
      const RefinedMotion motion = FitTrial(options, 0.0, trial, &pose_true);
      ASSERT_TRUE(motion.converged);
      const Vector5d error = LocalCoordinates(motion.cam2_from_cam1, pose_true);
      covered.Add(NormalizedErrorSquared(error, motion.pose_cov) <= ChiSquareQuantile(5, 0.95));
    }
    EXPECT_TRUE(covered.Admits(0.94)) << covered;  // 200 matches estimate the spread of psi: a little below
  }
}

// Of wrong matches a redescending loss takes no notice; Huber's is drawn by each with the same force.
TEST(MEstimation, TukeyIgnoresWhatIsWrong) {
  Moments huber, tukey;
  for (std::uint32_t trial = 0; trial < 100; ++trial) {
    RelativePose pose_true;
    for (const bool is_tukey : {false, true}) {
      const RefinedMotion motion = FitTrial(is_tukey ? kTukey : kHuber, 0.3, trial, &pose_true);
      EXPECT_TRUE(motion.converged || !is_tukey);
      if (motion.converged)
        (is_tukey ? tukey : huber).Add(RotationAngleBetween(motion.cam2_from_cam1.R, pose_true.R));
    }
  }
  EXPECT_LT(tukey.mean() + 2.0 * tukey.standard_error(), huber.mean());
}

TEST(MEstimation, OfAWideLossIsLeastSquares) {
  RelativePose pose_true;
  const MotionProblem problem = TwoCameraProblem(200, 0.5, 0.0, 0, &pose_true);
  const RefinedMotion squared = RefineAllBySampson(problem, pose_true);
  for (const RobustLoss loss : {RobustLoss::kHuber, RobustLoss::kTukey}) {
    const RefinedMotion wide = RefineByMEstimation(problem, pose_true, {loss, 1e4});
    ASSERT_TRUE(wide.converged);
    const Vector5d difference = LocalCoordinates(wide.cam2_from_cam1, squared.cam2_from_cam1);
    EXPECT_LT(NormalizedErrorSquared(difference, squared.pose_cov), 1e-4);
  }
}

// 24 matches, three of them wrong (x1, y1, x2, y2 in pixels; focal length 500, principal point (320, 240),
// sigma 0.5), and what SciPy 1.10's least_squares makes of them: m_estimation_reference.py.
constexpr double kMatches[24][4] = {
    {326.17, 424.77, 398.22, 402.8},  {447.3, 287.63, 456.49, 268.33},  {209.53, 249.47, 236.4, 231.15},
    {448.64, 191.69, 471.78, 165.7},  {224.7, 111.78, 302.44, 98},      {298.23, 339.71, 315.79, 319.19},
    {485.05, 246.53, 541.58, 235.95}, {267.05, 70.59, 363.44, 63.22},   {333.63, 265.68, 349.22, 246.59},
    {190.91, 297.24, 206.75, 275.7},  {388.81, 262.91, 400.75, 244.56}, {334.1, 357.32, 351.41, 351.22},
    {240.95, 81.9, 308.1, 68.08},     {510.06, 253.41, 592.98, 247.22}, {256.97, 229.88, 286.65, 211.97},
    {306.34, 140.46, 331.8, 124.04},  {218.37, 270.14, 236.22, 248.5},  {276.25, 359.52, 336.58, 346.33},
    {173.74, 275.08, 246.54, 257.27}, {243.23, 181.58, 274.36, 162.35}, {391.35, 312.47, 405.42, 293.39},
    {264.25, 241.84, 277.05, 221.46}, {312.11, 244, 389.46, 232.47},    {497.92, 309.63, 521.5, 293.88}};
struct Reference {
  RobustLoss loss;
  double cost, R[9], t[3];
};
constexpr Reference kReferences[] = {
    {RobustLoss::kHuber,
     72.3481249759,
     {0.999349422686, -0.0198887645609, -0.0300860170356, 0.0185175515231, 0.998806856107, -0.0451881010747,
      0.0309488555913, 0.0446015833507, 0.998525346248},
     {0.977727539431, 0.108501895955, 0.179655774223}},
    {RobustLoss::kTukey,
     22.007377009,
     {0.997524550873, -0.0232176262901, -0.0663755394304, 0.02003980884, 0.998639176368, -0.0481477048669,
      0.0674030894461, 0.0466983645511, 0.996632372684},
     {0.976394526532, 0.10093791216, 0.190958808246}},
};

TEST(MEstimation, EqualsAnotherImplementation) {
  MotionProblem problem;
  problem.camera1 =
      problem.camera2 = {.fx = 500, .fy = 500, .cx = 320, .cy = 240, .width = 640, .height = 480};
  problem.sigma_px = 0.5;
  for (const auto& m : kMatches) problem.matches.push_back({{m[0], m[1]}, {m[2], m[3]}});
  RelativePose start;
  start.R = Eigen::AngleAxisd(Eigen::Vector3d(0.05, -0.1, 0.02).norm(),
                              Eigen::Vector3d(0.05, -0.1, 0.02).normalized())
                .toRotationMatrix();
  start.t = Eigen::Vector3d(1.0, 0.1, 0.2).normalized();
  for (const Reference& reference : kReferences) {
    const RefinedMotion motion = RefineByMEstimation(problem, start, {reference.loss, 0.0});
    ASSERT_TRUE(motion.converged);
    const Eigen::Matrix3d R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(reference.R);
    EXPECT_LT((motion.cam2_from_cam1.R - R).norm(), 5e-5);
    EXPECT_LT((motion.cam2_from_cam1.t - Eigen::Map<const Eigen::Vector3d>(reference.t)).norm(), 5e-5);
    double cost = 0.0;
    const SampsonLinearization model(problem, motion.cam2_from_cam1);
    for (const Correspondence& match : problem.matches)
      cost += EvaluateRobustLoss({reference.loss, 0.0}, model.Evaluate(match).r).rho;
    EXPECT_NEAR(cost, reference.cost, 1e-6);
    EXPECT_GT((start.R - R).norm(), 0.01) << "the start is not the answer";
  }
}

TEST(MEstimation, OfTooFewMatchesHasNoCovariance) {
  RelativePose pose_true;
  MotionProblem problem = TwoCameraProblem(20, 0.5, 0.0, 0, &pose_true);
  problem.matches.resize(4);
  EXPECT_FALSE(RefineByMEstimation(problem, pose_true, kTukey).converged);
}

}  // namespace
}  // namespace rcme
