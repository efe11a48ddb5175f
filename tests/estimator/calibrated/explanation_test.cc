#include "estimator/calibrated/explanation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "estimator/calibrated/match_terms.h"
#include "estimator/noise_scale.h"
#include "tests/test_support/calibrated_mode.h"

namespace rcme {
namespace {

TEST(Explanation, OfEveryMatchIsThatOfTheScalarTwin) {
  for (const auto& [n, is_scaled] : {std::pair{7, false}, {50, false}, {61, false}, {61, true}}) {
    FittedMode f = FitScene(n, 0.5, 0.2, static_cast<std::uint32_t>(n));
    if (is_scaled) {
      for (int i = 0; i < n; ++i) f.problem.noise_scale.push_back(0.5 + 0.25 * (i % 7));
      f = FitFromTruth(f.problem, f.pose_true);
    }
    const MixtureParameters& m = f.mode.mixture;
    const Explanation e = Explain(f.matches, f.mode);
    ASSERT_EQ(e.probability.size(), static_cast<size_t>(n));
    int num_explained = 0;
    for (size_t i = 0; i < e.probability.size(); ++i) {
      const double scale = NoiseScaleAt(f.problem, i);
      const MatchTerms terms = EvaluateMatch(f.problem, f.mode.pose, f.problem.matches[i], scale);
      const MatchDensity d = EvaluateDensity(terms.residual, terms.depth, m, scale);
      EXPECT_EQ(WrongDensity(e, i, 0.25), 0.25 * scale);
      const double u = terms.residual / m.scale;
      EXPECT_NEAR(e.probability[i], d.right, 1e-9);
      EXPECT_NEAR(m.inlier_ratio * e.inlier_density[i], d.right * d.density, 1e-9);
      num_explained += d.right > 0.5;
      // The motion fitted without the match would leave r / (1 - h), of standard deviation s / sqrt(1 - h).
      if (d.right < 1e-3) continue;
      const double h = d.right * d.weight / (m.scale * m.scale) *
                       terms.derivative.dot(f.mode.inverse_hessian * terms.derivative);
      EXPECT_NEAR(e.leverage[i], std::min(h, 1.0), 1e-9);
      if (h > 0.99) continue;
      const double sd = 1.0 / std::sqrt(1.0 - h), left = u / (1.0 - h);
      const double expected =
          NoiseDensity(m.noise, left / sd) / sd * CheiralityFactor(terms.depth / m.scale) / m.scale;
      EXPECT_NEAR(e.left_out_density[i], expected, 1e-9);
    }
    EXPECT_EQ(e.num_explained, num_explained);
  }
}

// From the scatters of the two images by Eigen.
TEST(Explanation, ExtentIsTheRadiusOfTheExplainedMatches) {
  const FittedMode f = FitScene(200, 0.5, 0.3, 3);
  const Explanation e = Explain(f.matches, f.mode);
  Eigen::Matrix2d scatter[2] = {Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Zero()};
  for (const bool second : {false, true}) {
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    const auto point = [&](size_t i) -> Eigen::Vector2d {
      const MatchBlock& block = f.matches[static_cast<int>(i / kBlockSize)];
      const size_t lane = i % kBlockSize;
      return second ? Eigen::Vector2d(block.x2[lane], block.y2[lane])
                    : Eigen::Vector2d(block.x1[lane], block.y1[lane]);
    };
    for (size_t i = 0; i < e.probability.size(); ++i)
      if (e.probability[i] > 0.5) mean += point(i) / e.num_explained;
    for (size_t i = 0; i < e.probability.size(); ++i) {
      const Eigen::Vector2d away = point(i) - mean;
      if (e.probability[i] > 0.5) scatter[second] += away * away.transpose() / e.num_explained;
    }
  }
  EXPECT_NEAR(e.extent, std::pow(scatter[0].determinant() * scatter[1].determinant(), 0.125),
              1e-9 * e.extent);
}

// sum p v J' H^-1 J / s^2 is the trace of H^-1 times the information of all; H has between 0.6 of that and
// all of it (mixture_sums.h).
TEST(Explanation, LeveragesAddUpToTheFiveThatAMotionTakes) {
  for (const int n : {20, 100, 500}) {
    for (std::uint32_t trial = 0; trial < 5; ++trial) {
      const FittedMode f = FitScene(n, 0.5, 0.3, trial);
      const Explanation e = Explain(f.matches, f.mode);
      const double sum = std::accumulate(e.leverage.begin(), e.leverage.end(), 0.0);
      EXPECT_GE(sum, 4.0) << n;
      EXPECT_LE(sum, 5.0 / 0.6) << n;
    }
  }
}

// Of a match outside the fit the residual is its error and the fit's uncertainty: h = a / (1 + a) is the
// leverage that it would have in the fit with it (Sherman and Morrison).
TEST(Explanation, OfAMatchThatTheModeDoesNotUseIsAPrediction) {
  FittedMode f = FitScene(30, 0.5, 0.0, 1);
  const Explanation with = Explain(f.matches, f.mode);
  f.mode.used[1] = 0b11111011;  // without match 10
  const Explanation without = Explain(f.matches, f.mode);
  const double a = with.leverage[10], h = a / (1.0 + a);
  ASSERT_GT(a, 0.01);
  EXPECT_NEAR(without.leverage[10], h, 1e-12);
  const double u = without.terms.residual[10] / f.mode.mixture.scale, kept = std::sqrt(1.0 - h);
  const double in_front = without.inlier_density[10] / NoiseDensity(f.mode.mixture.noise, u);
  EXPECT_NEAR(without.left_out_density[10], NoiseDensity(f.mode.mixture.noise, u * kept) * kept * in_front,
              1e-12);
  EXPECT_EQ(without.probability[10], with.probability[10]);
  EXPECT_EQ(without.leverage[11], with.leverage[11]);
}

// A match counts as explained from one half on: where the background is such that match 0 is right with a
// probability of 0.7, or of 0.4.
TEST(Explanation, CountsMatchesThatAreMoreLikelyRight) {
  FittedMode f = FitScene(20, 0.5, 0.0, 3);
  const double w = f.mode.mixture.inlier_ratio;
  const std::vector<double> density = Explain(f.matches, f.mode).inlier_density;
  for (const double probability : {0.7, 0.4}) {
    f.mode.mixture.outlier_density = w * density[0] * (1.0 - probability) / probability / (1.0 - w);
    const Explanation e = Explain(f.matches, f.mode);
    EXPECT_NEAR(e.probability[0], probability, 1e-9);
    EXPECT_EQ(e.num_explained, std::ranges::count_if(e.probability, [](double p) { return p > 0.5; }));
    EXPECT_EQ(e.num_explained > 0, std::ranges::max(e.probability) > 0.5);
  }
}

// A motion follows a match by no more than all of it, however uncertain it is said to be.
TEST(Explanation, TheLeverageOfAUsedMatchIsAtMostOne) {
  FittedMode f = FitScene(20, 0.5, 0.0, 1);
  f.mode.inverse_hessian *= 1e3;
  EXPECT_EQ(std::ranges::max(Explain(f.matches, f.mode).leverage), 1.0);
}

}  // namespace
}  // namespace rcme
