#include <gtest/gtest.h>

#include <numbers>

#include "simulator/noise/noise_laws.h"
#include "stats/distributions.h"
#include "tests/simulator/noise/noise_sample.h"
#include "tests/test_support/goodness_of_fit.h"

namespace rcme {
namespace {

TEST(QuantisedNoise, PutsEveryCoordinateOnTheNearestGridLine) {
  for (const auto& [text, step] : {std::pair{"1", 1.0}, {"0.25", 0.25}, {"3", 3.0}}) {
    const auto law =
        WithSettings(MakeQuantisedNoise(), {{"sigma_px", "1e-9"}, {"quantisation_step_px", text}});
    RandomStream rng({.seed = 1, .purpose = 72}), noise_rng({.seed = 1, .purpose = 73});
    for (int i = 0; i < 1000; ++i) {
      const Eigen::Vector2d x1(rng.Uniform(0.0, 640.0), rng.Uniform(0.0, 480.0)), x2(x1.y(), x1.x());
      std::vector<Correspondence> matches = {{x1, x2}};
      law->AddTo(matches, noise_rng);
      for (const double x : {matches[0].x1_px.x(), matches[0].x1_px.y(), matches[0].x2_px.x()}) {
        EXPECT_LT(std::abs(x / step - std::round(x / step)), 1e-12);
      }
      EXPECT_LE((matches[0].x1_px - x1).cwiseAbs().maxCoeff(), 0.5 * step + 1e-7);
    }
  }
}

// Where the exact point is uniform within its grid cell, the noise is the sum of independent N(0, sigma^2)
// and U(-step / 2, step / 2): with h = step / 2 and G(z) = z Phi(z) + phi(z) its distribution function is
// sigma / (2 h) (G((e + h) / sigma) - G((e - h) / sigma)). Anderson-Darling at 1e-4 a coordinate; the
// Gaussian part alone, which is what sigma_px tells, is rejected.
TEST(QuantisedNoise, IsNormalPlusUniform) {
  constexpr double kSigma = 0.5, kHalfStep = 0.75;
  const auto law = WithSettings(MakeQuantisedNoise(), {{"sigma_px", "0.5"}, {"quantisation_step_px", "1.5"}});
  const auto G = [](double z) {
    return z * NormalCdf(z) + std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
  };
  const auto cdf = [&](double e) {
    return kSigma / (2.0 * kHalfStep) * (G((e + kHalfStep) / kSigma) - G((e - kHalfStep) / kSigma));
  };
  const std::vector<Eigen::Vector4d> noise = SampleNoise(*law, 20'000);
  for (int k = 0; k < 4; ++k) {
    EXPECT_GT(TestAndersonDarling(Coordinate(noise, k), cdf).p_value, 1e-4);
    EXPECT_LT(
        TestAndersonDarling(Coordinate(noise, k), [](double e) { return NormalCdf(e / kSigma); }).p_value,
        1e-6)
        << "no power";
  }
  // What sigma_px does not tell.
  EXPECT_EQ(law->sigma_px(), kSigma);
  const Moments square =
      ComputeMoments(noise, [](const Eigen::Vector4d& e) { return e.squaredNorm() / 4.0; });
  EXPECT_LT(std::abs(ZAgainst(square, kSigma * kSigma + 1.5 * 1.5 / 12.0)), kNoiseZ);
  EXPECT_GT(ZAgainst(square, kSigma * kSigma), 2.0 * kNoiseZ) << "no power";
}

}  // namespace
}  // namespace rcme
