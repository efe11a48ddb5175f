#include "simulator/calibration_error.h"

#include <gtest/gtest.h>

#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

TEST(CalibrationError, NothingIsToldWrongUnlessAskedFor) {
  const CalibrationError none;
  EXPECT_EQ(none.AssumedSigma(0.7), 0.7);
  EXPECT_EQ(none.AssumedCamera(TestCamera2()).K(), TestCamera2().K());
}

TEST(CalibrationError, ByHand) {
  CalibrationError error;
  for (const auto& [key, value] :
       {std::pair{"assumed_sigma_px", "0.3"}, {"focal_error", "0.1"}, {"principal_point_error_px", "-4"}}) {
    FindParameter(Parameters(error), key).SetFromText(value);
  }
  EXPECT_EQ(error.AssumedSigma(0.7), 0.3);
  const Camera assumed = error.AssumedCamera({700.0, 650.0, 330.0, 235.0, 640, 480});
  EXPECT_DOUBLE_EQ(assumed.fx, 770.0);
  EXPECT_DOUBLE_EQ(assumed.fy, 715.0);
  EXPECT_EQ(assumed.cx, 326.0);
  EXPECT_EQ(assumed.cy, 231.0);
  EXPECT_EQ(assumed.width, 640);
  EXPECT_EQ(assumed.height, 480);
}

}  // namespace
}  // namespace rcme
