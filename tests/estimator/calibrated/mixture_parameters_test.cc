// The constants of the noise law against the equations that define them.
#include "estimator/calibrated/mixture_parameters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "estimator/calibrated/explanation.h"

namespace rcme {
namespace {

// Of a smooth function over the whole line, x = sinh(y) by the trapezoid rule.
double ComputeIntegral(const std::function<double(double)>& f) {
  constexpr double kStep = 1e-2;
  double sum = 0.0;
  for (int i = -1500; i <= 1500; ++i) sum += f(std::sinh(kStep * i)) * std::cosh(kStep * i) * kStep;
  return sum;
}

class NoiseLawOf : public testing::TestWithParam<NoiseLaw> {};

TEST_P(NoiseLawOf, IsADensityOfStudentsLaw) {
  const NoiseLaw noise = GetParam();
  EXPECT_NEAR(ComputeIntegral([&](double u) { return NoiseDensity(noise, u); }), 1.0, 1e-8);
  EXPECT_NEAR(
      noise.peak,
      std::tgamma(noise.power) / (std::sqrt(noise.dof() * std::numbers::pi) * std::tgamma(noise.power - 0.5)),
      1e-9);
  // The variance of Student's law is dof / (dof - 2).
  EXPECT_NEAR(ComputeIntegral([&](double u) { return u * u * NoiseDensity(noise, u); }),
              noise.dof() / (noise.dof() - 2.0), 1e-5);
}

TEST_P(NoiseLawOf, TheWeightIsTheSlopeOfTheLogDensityOverTheResidual) {
  const NoiseLaw noise = GetParam();
  for (const double u : {0.1, 1.0, 4.0}) {
    constexpr double h = 1e-5;
    const double slope =
        (std::log(NoiseDensity(noise, u - h)) - std::log(NoiseDensity(noise, u + h))) / (2.0 * h);
    EXPECT_NEAR(NoiseWeight(noise, u), slope / u, 1e-8);
  }
}

TEST_P(NoiseLawOf, TheScaleOfGaussianNoiseIsThatOfMaximumLikelihood) {
  const NoiseLaw noise = GetParam();
  const auto expected_weighted_square = [&](double s) {
    return ComputeIntegral([&](double x) {
      const double normal = std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
      return 2.0 * noise.power * x * x / (noise.dof() * s * s + x * x) * normal;
    });
  };
  // It falls with s; the constant has four digits.
  EXPECT_GT(expected_weighted_square(noise.scale_of_gaussian - 1e-4), 1.0);
  EXPECT_LT(expected_weighted_square(noise.scale_of_gaussian + 1e-4), 1.0);
}

INSTANTIATE_TEST_SUITE_P(Both, NoiseLawOf, testing::Values(NoiseLaw(), kStudent15));

}  // namespace
}  // namespace rcme
