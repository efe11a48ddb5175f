// The mass within the bounds against closed forms.
#include "estimator/calibrated/failure_probability.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stats/distributions.h"

namespace rcme {
namespace {

constexpr MotionBounds kBounds{0.05, 0.25};
constexpr int kNumCalls = 400;

const RelativePose kAnswer{RotationFromVector({0.3, -0.2, 0.1}),
                           Eigen::Vector3d(1.0, 2.0, -0.5).normalized()};

double MeanMass(const RelativePose& mean, const Matrix5d& covariance) {
  double sum = 0.0;
  for (std::uint32_t call = 0; call < kNumCalls; ++call) {
    RandomStream rng({.seed = 1, .trial = call, .purpose = 2720});
    sum += MassWithin(kAnswer, kBounds, mean, covariance, rng);
  }
  return sum / kNumCalls;
}

// Both draws of a pair may agree always, so that 64 count; 4 standard errors are a false alarm in 16,000.
void ExpectMass(const RelativePose& mean, const Matrix5d& covariance, double expected) {
  const double standard_error = std::sqrt(expected * (1.0 - expected) / (64.0 * kNumCalls));
  EXPECT_NEAR(MeanMass(mean, covariance), expected, 4.0 * standard_error);
}

TEST(MassWithin, OfARotationAboutOneAxisIsTheNormalLaws) {
  for (const double sd : {0.02, 0.05, 0.2}) {
    Matrix5d covariance = 1e-12 * Matrix5d::Identity();
    covariance(1, 1) = sd * sd;
    ExpectMass(kAnswer, covariance, 2.0 * NormalCdf(kBounds.rotation_rad / sd) - 1.0);
    for (const double away : {0.03, 0.06}) {
      const RelativePose mean{RotationFromVector({0.0, away, 0.0}) * kAnswer.R, kAnswer.t};
      ExpectMass(
          mean, covariance,
          NormalCdf((kBounds.rotation_rad - away) / sd) - NormalCdf((-kBounds.rotation_rad - away) / sd));
    }
  }
}

TEST(MassWithin, OfARoundDirectionIsRayleighs) {
  for (const double sd : {0.1, 0.25, 0.5}) {
    Matrix5d covariance = 1e-12 * Matrix5d::Identity();
    covariance.bottomRightCorner<2, 2>() = sd * sd * Eigen::Matrix2d::Identity();
    ExpectMass(kAnswer, covariance,
               1.0 - std::exp(-0.5 * kBounds.direction_rad * kBounds.direction_rad / (sd * sd)));
  }
}

TEST(MassWithin, CorrelatedCoordinatesAreDrawnTogether) {
  // Both errors are multiples of one normal number: within both bounds if it is within the narrower.
  Vector5d along;
  along << 0.05, 0.0, 0.0, 0.1, 0.0;
  const Matrix5d covariance = along * along.transpose() + 1e-14 * Matrix5d::Identity();
  ExpectMass(kAnswer, covariance, 2.0 * NormalCdf(1.0) - 1.0);
}

TEST(MassWithin, IsPlainWithoutADraw) {
  RandomStream rng({.seed = 1, .purpose = 2721}), untouched({.seed = 1, .purpose = 2721});
  const Matrix5d narrow = 1e-8 * Matrix5d::Identity();
  EXPECT_EQ(MassWithin(kAnswer, kBounds, kAnswer, narrow, rng), 1.0);
  const RelativePose opposite{kAnswer.R, -kAnswer.t};
  EXPECT_EQ(MassWithin(kAnswer, kBounds, opposite, narrow, rng), 0.0);
  const RelativePose turned{RotationFromVector({0.0, 0.0, 0.1}) * kAnswer.R, kAnswer.t};
  EXPECT_EQ(MassWithin(kAnswer, kBounds, turned, narrow, rng), 0.0);
  EXPECT_EQ(rng.Next64(), untouched.Next64());
  MassWithin(kAnswer, kBounds, kAnswer, 1e-2 * Matrix5d::Identity(), rng);
  EXPECT_NE(rng.Next64(), untouched.Next64());
}

TEST(IsWithin, AsksForBothAnglesUpToTheBound) {
  const auto beside = [&](double rotation, double direction) {
    Vector5d tangent;
    tangent << rotation, 0.0, 0.0, 0.0, direction;
    return IsWithin(kAnswer, kBounds, Retract(kAnswer, tangent));
  };
  EXPECT_TRUE(beside(0.0499, 0.2499));
  EXPECT_FALSE(beside(0.0501, 0.0));
  EXPECT_FALSE(beside(0.0, 0.2501));
}

}  // namespace
}  // namespace rcme
