// The laws whose errors are not independent from match to match.
#include <gtest/gtest.h>

#include <numbers>

#include "simulator/noise/noise_laws.h"
#include "simulator/observe.h"
#include "stats/distributions.h"
#include "tests/simulator/noise/noise_sample.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/goodness_of_fit.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

// Half the squared difference of the errors of two points at a distance, one for each coordinate of either
// image: the variogram. Pairs are far from each other.
Moments Variogram(const NoiseModel& law, double distance_px) {
  Moments half_squares;
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    RandomStream place_rng({.seed = 1, .trial = trial, .purpose = 70}),
        rng({.seed = 1, .trial = trial, .purpose = 71});
    std::vector<Correspondence> exact;
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector2d corner(500.0 * (i % 10), 500.0 * (i / 10));
      const Eigen::Vector2d place = corner + Eigen::Vector2d(place_rng.Uniform(), place_rng.Uniform());
      const double angle = 2.0 * std::numbers::pi * place_rng.Uniform();
      const Eigen::Vector2d other = place + distance_px * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      exact.push_back({place, other});  // the second image has the points exchanged
      exact.push_back({other, place});
    }
    std::vector<Correspondence> noisy = exact;
    law.AddTo(noisy, rng);
    for (size_t i = 0; i < exact.size(); i += 2) {
      const auto add = [&](Eigen::Vector2d Correspondence::*x_px) {
        const Eigen::Vector2d difference =
            noisy[i].*x_px - exact[i].*x_px - (noisy[i + 1].*x_px - exact[i + 1].*x_px);
        for (const double d : difference) half_squares.Add(0.5 * d * d);
      };
      add(&Correspondence::x1_px);
      add(&Correspondence::x2_px);
    }
  }
  return half_squares;
}

// sigma^2 (1 - rho C(u)), C(u) = 1 - 4 u / pi + u^2 / pi up to the length, 0 from sqrt(2) times it on.
// z-tests at 1e-4, 8,000 squares each; a length that is two thirds, or a correlation that is 0.4 instead of
// 0.6, is seen.
TEST(CorrelatedNoise, HasTheStatedVariogram) {
  const double sigma = 0.5, rho = 0.6, length = 24.0;
  const auto law = WithSettings(
      MakeCorrelatedNoise(),
      {{"sigma_px", "0.5"}, {"noise_correlation", "0.6"}, {"noise_correlation_length_px", "24"}});
  const auto stated = [&](double d, double at_zero, double length_px) {
    const double u = d / length_px, pi = std::numbers::pi;
    return sigma * sigma * (1.0 - (u < 1.0 ? at_zero * (1.0 - 4.0 * u / pi + u * u / pi) : 0.0));
  };
  for (const double d : {0.5, 4.0, 8.0, 12.0, 18.0}) {
    EXPECT_LT(std::abs(ZAgainst(Variogram(*law, d), stated(d, rho, length))), kNoiseZ) << d;
  }
  EXPECT_LT(std::abs(ZAgainst(Variogram(*law, 36.0), stated(36.0, rho, length))), kNoiseZ);
  EXPECT_GT(std::abs(ZAgainst(Variogram(*law, 8.0), stated(8.0, rho, length * 2.0 / 3.0))), kNoiseZ)
      << "no power";
  EXPECT_GT(std::abs(ZAgainst(Variogram(*law, 4.0), stated(4.0, 0.4, length))), kNoiseZ) << "no power";
}

// With tails the variance is still that of sigma_px, and all four errors of a match are large together: of
// Student's t with three degrees of freedom. One match a trial; the mean square by a z-test at 1e-4, and the
// correlation of squares of two coordinates, 0 where they are independent, at 10 standard errors.
TEST(CorrelatedNoise, MayHaveTailsOfTheWholeMatch) {
  const auto law = WithSettings(MakeCorrelatedNoise(), {{"sigma_px", "2"}, {"noise_student_dof", "3"}});
  Moments square, product;
  for (std::uint32_t trial = 0; trial < 20'000; ++trial) {
    const Eigen::Vector4d e = SampleNoise(*law, 1, trial).front();
    square.Add(e.squaredNorm() / 16.0);
    product.Add((e(0) * e(0) / 4.0 - 1.0) * (e(3) * e(3) / 4.0 - 1.0));
  }
  EXPECT_LT(std::abs(ZAgainst(square, 1.0)), kNoiseZ);
  EXPECT_GT(ZAgainst(product, 0.0), 5.0);
}

TEST(CorrelatedNoise, HasNoTailsThatAreInfinite) {
  for (const char* dof : {"0.1", "0"})
    EXPECT_TRUE(SampleNoise(*WithSettings(MakeCorrelatedNoise(), {{"noise_student_dof", dof}}), 1, 1)
                    .front()
                    .allFinite())
        << dof;
  EXPECT_TRUE(ThrowsInputError(
      [] {
        SampleNoise(*WithSettings(MakeCorrelatedNoise(), {{"noise_student_dof", "0.05"}}), 1, 1);
      },
      {"noise_student_dof", "0.1 to 1000"}));
}

// One match a trial; Anderson-Darling of each coordinate at 1e-4. A sigma that is a fifth off is seen.
TEST(CorrelatedNoise, IsNormalAndOfTheStatedSigmaInEachCoordinate) {
  const auto law = WithSettings(MakeCorrelatedNoise(), {{"sigma_px", "2"}});
  std::vector<Eigen::Vector4d> noise;
  for (std::uint32_t trial = 0; trial < 5000; ++trial) noise.push_back(SampleNoise(*law, 1, trial).front());
  for (int k = 0; k < 4; ++k) {
    const std::vector<double> values = Coordinate(noise, k);
    EXPECT_GT(TestAndersonDarling(values, [](double e) { return NormalCdf(e / 2.0); }).p_value, 1e-4);
    EXPECT_LT(TestAndersonDarling(values, [](double e) { return NormalCdf(e / 2.4); }).p_value, 1e-4)
        << "no power";
  }
}

TEST(CorrelatedNoise, WithoutCorrelationNeighboursAreIndependent) {
  const auto law = WithSettings(MakeCorrelatedNoise(), {{"sigma_px", "1"}, {"noise_correlation", "0"}});
  EXPECT_LT(std::abs(ZAgainst(Variogram(*law, 0.5), 1.0)), kNoiseZ);
}

// Half the squared difference of the errors of two points is sigma^2 (1 - share exp(-d / reach)), that of one
// point squared is sigma^2. One pair of points a trial, since all points of one share its waves: z-tests at
// 1e-4, 16,000 squares each; a reach that is two thirds, or a share of 0.5 instead of 0.6, is seen.
TEST(DisplacementFieldNoise, HasTheStatedVariogram) {
  const auto law =
      WithSettings(MakeDisplacementFieldNoise(),
                   {{"sigma_px", "0.5"}, {"displacement_share", "0.6"}, {"displacement_reach_px", "40"}});
  const auto stated = [](double d, double share, double reach_px) {
    return 0.25 * (1.0 - share * std::exp(-d / reach_px));
  };
  Moments variance;
  for (const double d : {2.0, 20.0, 60.0}) {
    Moments half_squares;
    for (std::uint32_t trial = 0; trial < 4000; ++trial) {
      RandomStream rng({.seed = 2, .trial = trial, .purpose = 71});
      const double angle = 2.0 * std::numbers::pi * rng.Uniform();
      const Eigen::Vector2d at(200.0, 150.0),
          other = at + d * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      std::vector<Correspondence> moved = {{at, at}, {other, other}};
      law->AddTo(moved, rng);
      const Eigen::Vector2d e1 = moved[0].x1_px - at, e2 = moved[0].x2_px - at;
      const Eigen::Vector2d of1 = e1 - (moved[1].x1_px - other), of2 = e2 - (moved[1].x2_px - other);
      variance.Add(0.25 * (e1.squaredNorm() + e2.squaredNorm()));
      half_squares.Add(0.125 * (of1.squaredNorm() + of2.squaredNorm()));
    }
    EXPECT_LT(std::abs(ZAgainst(half_squares, stated(d, 0.6, 40.0))), kNoiseZ) << d;
    if (d == 20.0) {
      EXPECT_GT(std::abs(ZAgainst(half_squares, stated(d, 0.6, 27.0))), kNoiseZ) << "no power";
      EXPECT_GT(std::abs(ZAgainst(half_squares, stated(d, 0.5, 40.0))), kNoiseZ) << "no power";
    }
  }
  EXPECT_LT(std::abs(ZAgainst(variance, 0.25)), kNoiseZ);
}

// Of 2,000 matches 30 % are of a point that another is of (binomial, z-test at 1e-4). The errors of matches
// of one point have the stated correlation: half the mean squared difference is sigma^2 (1 - rho).
TEST(DuplicatedNoise, RepeatsPointsWithErrorsAlike) {
  const Scene scene = TwoCameraScene(2000, 1);
  const auto law = WithSettings(MakeDuplicatedNoise(), {{"sigma_px", "0.5"}});
  RandomStream noise_rng({.seed = 1, .purpose = 91}), outlier_rng({.seed = 1, .purpose = 92});
  const Observation observation = Observe(scene, *law, OutlierModel(0.0), noise_rng, outlier_rng);
  std::map<std::uint32_t, size_t> first_of;
  Moments half_squares;
  int num_repeated = 0;
  for (size_t i = 0; i < observation.matches.size(); ++i) {
    const auto [first, is_new] = first_of.try_emplace(observation.point[i], i);
    if (is_new) continue;
    ++num_repeated;
    const Correspondence &a = observation.matches[i], &b = observation.matches[first->second];
    for (const Eigen::Vector2d& difference :
         {Eigen::Vector2d(a.x1_px - b.x1_px), Eigen::Vector2d(a.x2_px - b.x2_px)}) {
      for (const double d : difference) half_squares.Add(0.5 * d * d);
    }
  }
  EXPECT_LT(std::abs(num_repeated - 0.3 * 2000), kNoiseZ * std::sqrt(0.3 * 0.7 * 2000));
  EXPECT_LT(std::abs(ZAgainst(half_squares, 0.25 * (1.0 - 0.8))), kNoiseZ);
  EXPECT_GT(std::abs(ZAgainst(half_squares, 0.25 * (1.0 - 0.7))), kNoiseZ) << "no power";
  // Every match lies at the point that it says it is of.
  Moments squares;
  for (size_t i = 0; i < observation.matches.size(); ++i) {
    const Correspondence exact = ImagedMatch(scene, {}, scene.points_in_cam1[observation.point[i]]);
    squares.Add((observation.matches[i].x1_px - exact.x1_px).squaredNorm() / 2.0);
  }
  EXPECT_NEAR(squares.mean(), 0.25, 0.05);
}

}  // namespace
}  // namespace rcme
