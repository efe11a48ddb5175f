#include "estimator/thresholds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stats/distributions.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

// An outlier costs what a uniform law over image 2's diagonal does, 1000 px here and 800 px in image 1.
TEST(Thresholds, AreThoseOfTheProblemAndTheOptions) {
  MotionProblem problem{{}, TestCamera1(), TestCamera2(), 0.25};
  RansacOptions options;
  options.significance_level = 0.02;
  const Thresholds printed = Thresholds::For(problem, options, 3);
  EXPECT_DOUBLE_EQ(printed.outlier_cost, std::log(1000.0 / 0.25));
  EXPECT_DOUBLE_EQ(printed.point, ChiSquareQuantile(3, 0.98));
  EXPECT_DOUBLE_EQ(printed.sample, ChiSquareQuantile(3, 0.98));
  EXPECT_DOUBLE_EQ(printed.normal, NormalQuantile(0.98));
  options.sample_significance_level = 0.1;
  for (const int dof : {1, 3}) {
    const Thresholds own_level = Thresholds::For(problem, options, dof);
    EXPECT_DOUBLE_EQ(own_level.point, ChiSquareQuantile(dof, 0.98));
    EXPECT_DOUBLE_EQ(own_level.sample, ChiSquareQuantile(3, 0.9));
  }
  problem.sigma_px = 5000.0;
  EXPECT_EQ(Thresholds::For(problem, options, 1).outlier_cost, 0.0) << "noise wider than the image";
}

}  // namespace
}  // namespace rcme
