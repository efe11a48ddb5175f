#include <gtest/gtest.h>

#include "simulator/noise/noise_laws.h"
#include "stats/constants.h"
#include "stats/distributions.h"
#include "tests/simulator/noise/noise_sample.h"
#include "tests/test_support/goodness_of_fit.h"
#include "tests/test_support/linear_algebra.h"

namespace rcme {
namespace {

// The covariance (4x4, px^2) by definition, for sigma_px = 1.
Eigen::Matrix4d Covariance(double axis_ratio, double axis_deg, double image_correlation) {
  const double angle = RadFromDeg(axis_deg);
  const double minor = std::sqrt(2.0 / (1.0 + axis_ratio * axis_ratio)), major = axis_ratio * minor;
  Eigen::Matrix2d axes;
  axes << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  const Eigen::Matrix2d one_image =
      axes * Eigen::Vector2d(major * major, minor * minor).asDiagonal() * axes.transpose();
  Eigen::Matrix4d both;
  both << one_image, image_correlation * one_image, image_correlation * one_image, one_image;
  return both;
}

// The p-value of the four whitened coordinates of all matches against a standard normal.
double WhitenedPValue(const std::vector<Eigen::Vector4d>& noise, const Eigen::Matrix4d& covariance) {
  const Eigen::Matrix4d whitening = Inverse(CholeskyFactor(covariance));
  std::vector<double> whitened;
  for (const Eigen::Vector4d& e : noise) {
    const Eigen::Vector4d z = whitening * e;
    whitened.insert(whitened.end(), z.data(), z.data() + 4);
  }
  return TestKolmogorovSmirnov(whitened, NormalCdf).p_value;
}

// Normal marginals at 1e-4 and each of the ten covariances at 1e-4 (together at 3 x 11 x 1e-4). A ratio of
// the axes of 1, or axes that are turned by 30 deg or mirrored, are seen.
TEST(AnisotropicNoise, HasTheCovarianceOfItsDefinition) {
  const struct {
    double ratio, deg, correlation;
  } kCases[] = {{3.0, 45.0, 0.0}, {2.0, 110.0, 0.7}, {5.0, 20.0, -0.9}};
  for (const auto& [ratio, deg, correlation] : kCases) {
    const auto law =
        WithSettings(MakeAnisotropicNoise(), {{"sigma_px", "1"},
                                              {"noise_axis_ratio", std::to_string(ratio)},
                                              {"noise_axis_deg", std::to_string(deg)},
                                              {"image_correlation", std::to_string(correlation)}});
    const std::vector<Eigen::Vector4d> noise = SampleNoise(*law, 20'000);
    const Eigen::Matrix4d expected = Covariance(ratio, deg, correlation);
    EXPECT_GT(WhitenedPValue(noise, expected), 1e-4);
    EXPECT_LT(WhitenedPValue(noise, 1.21 * expected), 1e-10) << "no power";
    for (int i = 0; i < 4; ++i) {
      for (int j = i; j < 4; ++j) {
        const Moments product = ComputeMoments(noise, [&](const Eigen::Vector4d& e) { return e(i) * e(j); });
        EXPECT_LT(std::abs(ZAgainst(product, expected(i, j))), kNoiseZ) << i << " " << j;
      }
    }
    const Moments xy = ComputeMoments(noise, [](const Eigen::Vector4d& e) { return e(0) * e(1); });
    for (const Eigen::Matrix4d& wrong :
         {Covariance(ratio, deg + 30.0, correlation), Covariance(ratio, -deg, correlation),
          Covariance(1.0, deg, correlation)}) {
      EXPECT_GT(std::abs(ZAgainst(xy, wrong(0, 1))), 2.0 * kNoiseZ) << "no power";
    }
  }
}

TEST(AnisotropicNoise, FullCorrelationMovesBothImagesAlike) {
  for (const double correlation : {1.0, -1.0}) {
    const auto law =
        WithSettings(MakeAnisotropicNoise(), {{"image_correlation", correlation > 0.0 ? "1" : "-1"}});
    for (const Eigen::Vector4d& e : SampleNoise(*law, 100)) {
      EXPECT_LT((e.tail<2>() - correlation * e.head<2>()).norm(), 1e-12);
      EXPECT_GT(e.norm(), 1e-6);
    }
  }
}

TEST(AnisotropicNoise, WithEqualAxesItIsTheGaussianLaw) {
  const auto law = WithSettings(MakeAnisotropicNoise(), {{"sigma_px", "1"}, {"noise_axis_ratio", "1"}});
  EXPECT_GT(WhitenedPValue(SampleNoise(*law, 20'000), Eigen::Matrix4d::Identity()), 1e-4);
}

}  // namespace
}  // namespace rcme
