#include "estimator/model_choice/two_view_models.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "stats/constants.h"
#include "stats/moments.h"
#include "tests/test_support/family_problem.h"

namespace rcme {
namespace {

TwoViewFits FitTrial(const ProblemFamily& family, std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 98});
  return FitTwoViewModels(family.Make(trial), rng);
}

double SumUpTo(const std::vector<double>& squared, double bound) {
  return std::accumulate(squared.begin(), squared.end(), 0.0,
                         [&](double sum, double e2) { return sum + std::min(e2, bound); });
}

// Where a model is true and no match is wrong, its sum of e^2 has codimension * n - k degrees of freedom. The
// mean of 60 trials of 200 matches lies within four standard errors of that, and up to one in a hundred below
// for the fits leave out what lies beyond 99.9 %.
TEST(FitTwoViewModels, TheTrueModelLeavesTheNoise) {
  const struct {
    TwoViewModel model;
    const char *scene, *motion;
  } kCases[] = {{TwoViewModel::kRotation, "uniform_volume", "pure_rotation"},
                {TwoViewModel::kHomography, "plane", "general"},
                {TwoViewModel::kEssential, "uniform_volume", "general"},
                {TwoViewModel::kEssential, "plane", "general"}};
  for (const auto& c : kCases) {
    const ProblemFamily family(c.scene, c.motion, 200, 0.0);
    const ModelDimensions& dimensions = FindDimensions(c.model);
    const double dof = 200.0 * dimensions.codimension() - dimensions.parameters;
    Moments sums;
    for (std::uint32_t trial = 0; trial < 60; ++trial) {
      sums.Add(SumUpTo(FitTrial(family, trial)[c.model].squared_residuals, kInfinity));
    }
    const double tolerance = 4.0 * std::sqrt(2.0 * dof / 60.0);
    EXPECT_LT(sums.mean(), dof + tolerance + 0.01 * dof) << c.scene;
    EXPECT_GT(sums.mean(), dof - tolerance) << c.scene;
  }
}

// A rotation is a homography and a case of an epipolar geometry: what it leaves the others do not exceed, the
// epipolar geometry's residual being a part of the rotation's to first order.
TEST(FitTwoViewModels, LargerModelsLeaveLess) {
  for (const char* motion : {"pure_rotation", "vanishing_baseline", "general"}) {
    const ProblemFamily family("uniform_volume", motion, 100, 0.4);
    for (std::uint32_t trial = 0; trial < 10; ++trial) {
      const TwoViewFits fits = FitTrial(family, trial);
      const double rotation = SumUpTo(fits.rotation.squared_residuals, 13.8),
                   homography = SumUpTo(fits.homography.squared_residuals, 13.8),
                   essential = SumUpTo(fits.essential.squared_residuals, 13.8);
      EXPECT_LE(homography, 1.01 * rotation) << motion;
      EXPECT_LE(essential, 1.01 * rotation) << motion;
    }
  }
}

TEST(FitTwoViewModels, FindsTheModelsAmongWrongMatches) {
  const ProblemFamily family("plane", "general", 300, 0.5);
  for (std::uint32_t trial = 0; trial < 10; ++trial) {
    const TwoViewFits fits = FitTrial(family, trial);
    EXPECT_GE(FindInliers(fits.homography, TwoViewModel::kHomography, 0.001).size(), 140u);
    EXPECT_GE(FindInliers(fits.essential, TwoViewModel::kEssential, 0.001).size(), 140u);
    EXPECT_LE(FindInliers(fits.homography, TwoViewModel::kHomography, 0.001).size(), 160u);
  }
}

TEST(FindInliers, AreTheMatchesWithinTheQuantile) {
  ModelFit fit;
  fit.squared_residuals = {3.8, 3.9, 5.9, 6.0, kInfinity};
  EXPECT_EQ(FindInliers(fit, TwoViewModel::kEssential, 0.05), (std::vector<int>{0}));
  EXPECT_EQ(FindInliers(fit, TwoViewModel::kRotation, 0.05), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(FindInliers(fit, TwoViewModel::kHomography, 0.05), (std::vector<int>{0, 1, 2}));
}

}  // namespace
}  // namespace rcme
