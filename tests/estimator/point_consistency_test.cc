#include "estimator/point_consistency.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numbers>

#include "estimator/uncertainty/sampson_covariance.h"
#include "stats/distributions.h"
#include "tests/estimator/uncertain_motion.h"
#include "tests/test_support/coverage_count.h"
#include "tests/test_support/linear_algebra.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

double Distance(const auto& test, const Correspondence& match) {
  PointResidual residual;
  return test.Distance(match, &residual);
}

double Entropy(const auto& test, const Correspondence& match) {
  PointResidual residual;
  test.Distance(match, &residual);
  return test.Entropy(residual);
}

// delta' Sigma_delta^-1 delta and log det Sigma_delta by the textbook route (the equations as printed,
// written out again here) in long double, whose 4x4 inverse still has digits where g is small. Sigma_delta
// comes along.
using LongMatrix4 = Eigen::Matrix<long double, 4, 4>;
struct Textbook {
  double d2, log_det;
  LongMatrix4 cov;
  double condition;
};

Textbook TextbookDistance(const Eigen::Matrix3d& F, const std::array<Eigen::Matrix3d, 5>& dF_dp,
                          const Matrix5d& pose_cov, double sigma_px, const Correspondence& match) {
  using Matrix3 = Eigen::Matrix<long double, 3, 3>;
  using Vector3 = Eigen::Matrix<long double, 3, 1>;
  using Vector4 = Eigen::Matrix<long double, 4, 1>;
  const Vector3 x1(match.x1_px.x(), match.x1_px.y(), 1.0L), x2(match.x2_px.x(), match.x2_px.y(), 1.0L);
  const auto gradient = [&](const Matrix3& M) {
    const Vector3 line1 = M.transpose() * x2, line2 = M * x1;
    return Vector4(line1(0), line1(1), line2(0), line2(1));
  };
  const Matrix3 F_long = F.cast<long double>();
  const long double g = x2.dot(F_long * x1);
  const Vector4 j = gradient(F_long);
  const long double n2 = j.squaredNorm();
  LongMatrix4 H = LongMatrix4::Zero();
  H.topRightCorner<2, 2>() = F_long.topLeftCorner<2, 2>().transpose();
  H.bottomLeftCorner<2, 2>() = F_long.topLeftCorner<2, 2>();
  const LongMatrix4 by_X =
      -(j * j.transpose() / n2 + (g / n2) * H - 2.0L * (g / (n2 * n2)) * j * (j.transpose() * H));
  Eigen::Matrix<long double, 4, 5> by_p;
  for (int k = 0; k < 5; ++k) {
    const Matrix3 dF = dF_dp[static_cast<size_t>(k)].cast<long double>();
    const long double g_k = x2.dot(dF * x1);
    const Vector4 j_k = gradient(dF);
    by_p.col(k) = -(j * (g_k / n2) + (g / n2) * j_k - 2.0L * (g / (n2 * n2)) * j * j.dot(j_k));
  }
  Textbook result;
  const long double sigma2 = static_cast<long double>(sigma_px) * sigma_px;
  result.cov = sigma2 * by_X * by_X.transpose() + by_p * pose_cov.cast<long double>() * by_p.transpose();
  const Vector4 delta = -(g / n2) * j;
  const Eigen::FullPivLU<LongMatrix4> lu(result.cov);
  result.d2 = static_cast<double>(delta.dot(lu.solve(delta)));
  result.log_det = static_cast<double>(std::log(std::abs(lu.determinant())));
  const Eigen::VectorXd singular_values = SingularValues(result.cov.cast<double>());
  result.condition = singular_values(0) / std::max(singular_values(3), 1e-300);
  return result;
}

// --- closed forms

TEST(SampsonCovariance, AgreesWithTheEquationsInLongDouble) {
  RandomStream rng({.seed = 1, .purpose = 203});
  for (int i = 0; i < 300; ++i) {
    RandomProblem random = MakeRandomProblem(rng, {.num_matches = 1});
    AddNoise(2.0, rng, &random.problem);
    const Matrix5d pose_cov = RandomPoseCov(0.003, rng);
    const Correspondence& match = random.problem.matches[0];
    const Eigen::Matrix4d cov = CovarianceOfSampsonVector(ComputeFundamental(random),
                                                          FundamentalTangent(random), pose_cov, 0.5, match);
    const Textbook textbook =
        TextbookDistance(ComputeFundamental(random), FundamentalTangent(random), pose_cov, 0.5, match);
    EXPECT_LT((cov - textbook.cov.cast<double>()).norm(), 1e-10 * cov.norm());
    EXPECT_GT(cov.norm(), 0.01);
  }
}

// Holds AsPrintedTest against the textbook route wherever the latter keeps 8 digits. The motion's standard
// deviations are 2^-4 to 2^-max_exponent rad.
void CompareWithTextbook(double max_exponent, std::uint32_t purpose) {
  RandomStream rng({.seed = 1, .purpose = purpose});
  int num_compared = 0;
  for (int i = 0; i < 2000; ++i) {
    RandomProblem random = MakeRandomProblem(rng, {.num_matches = 1, .max_rotation_deg = 30.0});
    AddNoise(2.0, rng, &random.problem);
    const Correspondence& match = random.problem.matches[0];
    const double std_dev = std::exp2(-rng.Uniform(4.0, max_exponent));
    const Matrix5d pose_cov = RandomPoseCov(std_dev, rng);
    const Textbook textbook =
        TextbookDistance(ComputeFundamental(random), FundamentalTangent(random), pose_cov, 0.5, match);
    if (!(textbook.condition < 1e11)) continue;
    ++num_compared;
    const AsPrintedTest test(ComputeUncertainModel(random, pose_cov), 0.5);
    PointResidual residual;
    ASSERT_NEAR(test.Distance(match, &residual), textbook.d2, 1e-6 * textbook.d2) << "motion to " << std_dev;
    ASSERT_EQ(residual.d2, Distance(test, match));
    ASSERT_NEAR(residual.log_det_cov, textbook.log_det, 1e-6 * std::abs(textbook.log_det) + 1e-6);
    const double entropy =
        0.5 * (4.0 * std::log(2.0 * std::numbers::pi * std::numbers::e) + textbook.log_det);
    ASSERT_NEAR(test.Entropy(residual), entropy, 1e-6 * std::abs(entropy) + 1e-6);
    ASSERT_EQ(test.NegativeLogLikelihood(residual), 0.0);
  }
  EXPECT_GT(num_compared, 1000);
}

TEST(AsPrintedTest, ClosedFormEqualsTheFourByFourInverse) { CompareWithTextbook(12.0, 204); }

// Refined motions are known to 1e-4 rad and better, where the point noise rules.
TEST(AsPrintedTest, ClosedFormHoldsForWellKnownMotions) { CompareWithTextbook(30.0, 211); }

TEST(AsPrintedTest, KnownMotionMeasuresTheDistanceFromTheEpipoles) {
  // With Sigma_p = 0, d2 = |H^-1 j|^2 / sigma^2 times (e / (j' H^-1 j / |j| - e))^2, e = g / |j| (a closed
  // form of the 4x4 route). F has rank 2, so that j' H^-1 j = 2 g and the factor is 1, and H^-1 j = [x1 -
  // epipole1; x2 - epipole2]: the printed statistic of a known motion is the squared distance of the match
  // from the two epipoles, whatever its residual.
  RandomStream rng({.seed = 1, .purpose = 212});
  int num_compared = 0;
  for (int i = 0; i < 2000; ++i) {
    RandomProblem random = MakeRandomProblem(rng, {.num_matches = 1, .max_rotation_deg = 30.0});
    AddNoise(2.0, rng, &random.problem);
    const Correspondence& match = random.problem.matches[0];
    const Eigen::Vector3d center2_in_1 = -random.pose_true.R.transpose() * random.pose_true.t;
    const Eigen::Vector2d epipole1 = random.problem.camera1.Project(center2_in_1);
    const Eigen::Vector2d epipole2 = random.problem.camera2.Project(random.pose_true.t);
    const double squared_px = (match.x1_px - epipole1).squaredNorm() + (match.x2_px - epipole2).squaredNorm();
    const double residual_px = std::sqrt(SquaredSampsonDistance(ComputeFundamental(random), match));
    // The statistic is a difference of numbers (distance / residual)^2 times larger.
    const double lost = squared_px / (residual_px * residual_px);
    if (lost > 1e8) continue;
    ++num_compared;
    const double d2 = squared_px / 0.25;
    ASSERT_NEAR(Distance(AsPrintedTest(ComputeUncertainModel(random, Matrix5d::Zero()), 0.5), match), d2,
                1e-12 * lost * d2);
  }
  EXPECT_GT(num_compared, 500);
}

TEST(AsPrintedTest, DeterminantFallsWithTheSixthPowerOfG) {
  // The printed entropy holds 3 log|g|. Along the gradient, a residual ten times smaller
  // takes 3 log 10 = 6.9 nats off; nothing of the kind happens to the rank-aware entropy.
  RandomStream rng({.seed = 1, .purpose = 205});
  for (int i = 0; i < 50; ++i) {
    const RandomProblem random = MakeRandomProblem(rng, {.num_matches = 1});
    const UncertainFundamental model = ComputeUncertainModel(random, RandomPoseCov(0.001, rng));
    const Correspondence exact = random.problem.matches[0];
    const Eigen::Vector4d unit = EvaluateConstraint(model.F, exact).gradient.normalized();
    const auto at = [&](double distance_px) {
      return Correspondence{exact.x1_px + distance_px * unit.head<2>(),
                            exact.x2_px + distance_px * unit.tail<2>()};
    };
    const AsPrintedTest printed(model, 0.5);
    EXPECT_NEAR(Entropy(printed, at(1e-3)) - Entropy(printed, at(1e-4)), 3.0 * std::log(10.0), 0.05);
    const RankAwareTest rank_aware(model, 0.5);
    EXPECT_NEAR(Entropy(rank_aware, at(1e-3)) - Entropy(rank_aware, at(1e-4)), 0.0, 1e-3);
  }
}

TEST(AsPrintedTest, ExactMatchHasAFiniteEntropy) {
  // g = 0 to the last bit: sideways motion with a yaw, both points on the horizon.
  const Camera camera{500.0, 500.0, 0.0, 0.0, 1000, 1000};
  const RelativePose pose{RotationFromVector({0.0, 0.1, 0.0}), Eigen::Vector3d(0.6, 0.0, 0.8)};
  const auto model = UncertainFundamental::From(pose, 1e-6 * Matrix5d::Identity(), camera, camera);
  const Correspondence match{{100.0, 0.0}, {140.0, 0.0}};
  ASSERT_EQ(EvaluateConstraint(model->F, match).g, 0.0);
  const AsPrintedTest printed(*model, 0.5);
  PointResidual residual;
  EXPECT_EQ(printed.Distance(match, &residual), 0.0);
  EXPECT_TRUE(std::isfinite(printed.Entropy(residual)));
}

TEST(AsPrintedTest, SingularCovarianceAdmitsNothing) {
  // Pure sideways motion known exactly: F has no upper left block, H = 0, Sigma_delta has rank one for every
  // match.
  const Camera camera{500.0, 500.0, 0.0, 0.0, 1000, 1000};
  const auto model = UncertainFundamental::From({}, Matrix5d::Zero(), camera, camera);
  PointResidual residual;
  EXPECT_TRUE(std::isinf(AsPrintedTest(*model, 0.5).Distance({{100.0, 20.0}, {140.0, 21.0}}, &residual)));
}

TEST(RankAwareTest, IsTheResidualOverItsOwnStandardDeviation) {
  RandomStream rng({.seed = 1, .purpose = 206});
  for (int i = 0; i < 300; ++i) {
    RandomProblem random = MakeRandomProblem(rng, {.num_matches = 1});
    AddNoise(2.0, rng, &random.problem);
    const Correspondence& match = random.problem.matches[0];
    const Matrix5d pose_cov = RandomPoseCov(0.003, rng);
    const Eigen::Matrix3d F = ComputeFundamental(random);
    const std::array<Eigen::Matrix3d, 5> dF_dp = FundamentalTangent(random);
    const EpipolarConstraint c = EvaluateConstraint(F, match);
    Vector5d g_p;
    for (int k = 0; k < 5; ++k) g_p(k) = EvaluateConstraint(dF_dp[static_cast<size_t>(k)], match).g;
    const double s2 = 0.25 + g_p.dot(pose_cov * g_p) / c.squared_gradient();
    const RankAwareTest test(ComputeUncertainModel(random, pose_cov), 0.5);
    PointResidual residual;
    const double d2 = c.g * c.g / (c.squared_gradient() * s2);
    EXPECT_NEAR(test.Distance(match, &residual), d2, 1e-11 * d2);
    EXPECT_NEAR(residual.log_det_cov, std::log(s2), 1e-11);
    EXPECT_NEAR(test.Entropy(residual), 0.5 * std::log(s2 / 0.25), 1e-11);
    EXPECT_GE(test.Entropy(residual), 0.0);
    // -log of the density of the signed residual under N(0, s2), in units of sigma.
    EXPECT_NEAR(test.NegativeLogLikelihood(residual),
                0.5 * residual.d2 + 0.5 * std::log(2.0 * std::numbers::pi * s2 / 0.25), 1e-11);
    // The printed rank-one part: to first order the rank-aware s2 is the variance of Sigma_delta along J.
    const Eigen::Vector4d unit = c.gradient.normalized();
    const Eigen::Matrix4d cov = CovarianceOfSampsonVector(F, dF_dp, pose_cov, 0.5, random.problem.matches[0]);
    EXPECT_NEAR(unit.dot(cov * unit), s2, 0.1 * s2);
  }
}

TEST(RankAwareTest, KnownMotionHasNoExcessEntropyAndTheKnownPoseDistance) {
  RandomStream rng({.seed = 1, .purpose = 207});
  for (int i = 0; i < 50; ++i) {
    RandomProblem random = MakeRandomProblem(rng, {.num_matches = 1});
    AddNoise(2.0, rng, &random.problem);
    const RankAwareTest test(ComputeUncertainModel(random, Matrix5d::Zero()), 0.5);
    const KnownPoseTest known(ComputeFundamental(random), 0.5);
    EXPECT_NEAR(Entropy(test, random.problem.matches[0]), 0.0, 1e-15);
    const double d2 = Distance(known, random.problem.matches[0]);
    EXPECT_NEAR(Distance(test, random.problem.matches[0]), d2, 1e-12 * d2);
    EXPECT_NEAR(d2, 4.0 * SquaredSampsonDistance(ComputeFundamental(random), random.problem.matches[0]),
                1e-12 * d2);
  }
}

TEST(PointTests, UnitsOfPixelsMatterAsStated) {
  // Pixels, K and sigma times 1000 (one image in millipixels): distances and excess entropy stay, the printed
  // entropy moves by 4 log 1000 and the density of the residual by nothing, being in units of sigma.
  constexpr double kScale = 1000.0;
  RandomStream rng({.seed = 1, .purpose = 208});
  for (int i = 0; i < 200; ++i) {
    RandomProblem random = MakeRandomProblem(rng, {.num_matches = 1});
    AddNoise(2.0, rng, &random.problem);
    const Matrix5d pose_cov = RandomPoseCov(0.003, rng);
    RandomProblem scaled = random;
    for (Camera* camera : {&scaled.problem.camera1, &scaled.problem.camera2}) {
      for (double* value : {&camera->fx, &camera->fy, &camera->cx, &camera->cy}) *value *= kScale;
    }
    const Correspondence match = random.problem.matches[0];
    const Correspondence scaled_match{kScale * match.x1_px, kScale * match.x2_px};
    const UncertainFundamental model = ComputeUncertainModel(random, pose_cov),
                               scaled_model = ComputeUncertainModel(scaled, pose_cov);

    const RankAwareTest rank_aware(model, 0.5), scaled_rank_aware(scaled_model, 0.5 * kScale);
    PointResidual residual, scaled_residual;
    const double d2 = rank_aware.Distance(match, &residual);
    EXPECT_NEAR(scaled_rank_aware.Distance(scaled_match, &scaled_residual), d2, 1e-9 * d2);
    EXPECT_NEAR(scaled_rank_aware.Entropy(scaled_residual), rank_aware.Entropy(residual), 1e-9);
    EXPECT_NEAR(scaled_rank_aware.NegativeLogLikelihood(scaled_residual),
                rank_aware.NegativeLogLikelihood(residual), 1e-9 * (1.0 + d2));

    const AsPrintedTest printed(model, 0.5), scaled_printed(scaled_model, 0.5 * kScale);
    const double printed_d2 = Distance(printed, match);
    EXPECT_NEAR(Distance(scaled_printed, scaled_match), printed_d2, 1e-7 * printed_d2);
    EXPECT_NEAR(Entropy(scaled_printed, scaled_match) - Entropy(printed, match), 4.0 * std::log(kScale),
                1e-7);
  }
}

// --- coverage

// Fresh points of many random motions that are known exactly, true noise `sigma_px`, the test assuming
// `assumed_px`.
struct KnownMotionCoverage {
  CoverageCount rank_aware, as_printed;
};

KnownMotionCoverage MeasureKnownMotion(double sigma_px, double assumed_px, std::uint32_t purpose) {
  const double limit_1 = ChiSquareQuantile(1, 0.95), limit_3 = ChiSquareQuantile(3, 0.95);
  KnownMotionCoverage coverage;
  RandomStream rng({.seed = 1, .purpose = purpose});
  for (int motion = 0; motion < 2000; ++motion) {
    RandomProblem random = MakeRandomProblem(rng, {.num_matches = 20});
    AddNoise(sigma_px, rng, &random.problem);
    const UncertainFundamental model = ComputeUncertainModel(random, Matrix5d::Zero());
    const RankAwareTest rank_aware(model, assumed_px);
    const AsPrintedTest as_printed(model, assumed_px);
    for (const Correspondence& match : random.problem.matches) {
      coverage.rank_aware.Add(Distance(rank_aware, match) <= limit_1);
      coverage.as_printed.Add(Distance(as_printed, match) <= limit_3);
    }
  }
  return coverage;
}

TEST(PointTests, CoverageWithAKnownMotion) {
  // 40 000 fresh points at sigma 0.5 px, false alarm 1e-4, interval 0.0085 wide; assuming 0.45 (0.55) px the
  // rank-aware test covers 0.922 (0.969). The printed one covers next to nothing: see
  // KnownMotionMeasuresTheDistanceFromTheEpipoles.
  const KnownMotionCoverage coverage = MeasureKnownMotion(0.5, 0.5, 209);
  EXPECT_TRUE(coverage.rank_aware.Admits(0.95)) << coverage.rank_aware;
  EXPECT_LT(coverage.as_printed.interval().upper, 0.5) << coverage.as_printed;
  // Power: a sigma that is wrong by 10 % either way is rejected.
  EXPECT_FALSE(MeasureKnownMotion(0.5, 0.45, 209).rank_aware.Admits(0.95));
  EXPECT_FALSE(MeasureKnownMotion(0.5, 0.55, 209).rank_aware.Admits(0.95));
}

}  // namespace
}  // namespace rcme
