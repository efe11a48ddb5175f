// Real lenses, against OpenCV.
#include "estimator/geometry/lens.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/test_support/expect_input_error.h"

namespace rcme {
namespace {

// cv::projectPoints and cv::fisheye::projectPoints of OpenCV 4.6 at (.5, -.3, 1) and (-.2, .4, 1).
TEST(Lens, DistortsAsOpenCv) {
  const Camera euroc{458.654, 457.296, 367.215, 248.375, 752, 480};
  const auto expect = [&](LensModel model, const std::vector<double>& k, const Eigen::Vector2d& first,
                          const Eigen::Vector2d& second) {
    const Lens lens = MakeLens(euroc, model, k, "");
    EXPECT_LT((ProjectThrough(lens, {0.5, -0.3}) - first).norm(), 2e-6) << ProjectThrough(lens, {0.5, -0.3});
    EXPECT_LT((ProjectThrough(lens, {-0.2, 0.4}) - second).norm(), 2e-6) << ProjectThrough(lens, {-0.2, 0.4});
  };
  expect(LensModel::kRadtan, {-0.28, 0.07, 0.02, -0.03}, {562.255779, 132.007984}, {275.043892, 428.513040});
  expect(LensModel::kRadtan, {0.1, -0.2, 0.01, 0.02, 0.3, 0.5, -0.1, 0.2}, {574.629873, 127.715124},
         {284.272171, 418.342457});
  expect(LensModel::kFisheye, {-0.1, 0.2, -0.3, 0.4}, {571.424674, 126.211974}, {282.051848, 418.196996});
}

TEST(Lens, UndistortsWhatItDistorts) {
  const Camera euroc{458.654, 457.296, 367.215, 248.375, 752, 480};
  const std::vector<Lens> lenses = {
      MakeLens(euroc, LensModel::kPinhole, {}, ""),
      MakeLens(euroc, LensModel::kRadtan, {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05}, ""),
      MakeLens(euroc, LensModel::kRadtan, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}, ""),
      MakeLens(euroc, LensModel::kRadtan, {0.1, -0.2, 0.001, 0.002, 0.03, 0.05, -0.1, 0.02}, ""),
      MakeLens(euroc, LensModel::kFisheye, {-0.01, 0.02, -0.01, 0.003}, "")};
  for (const Lens& lens : lenses) {
    for (double x = -0.6; x <= 0.6; x += 0.1) {
      for (double y = -0.4; y <= 0.4; y += 0.1) {
        const std::optional<Eigen::Vector2d> ideal = Undistort(lens, ProjectThrough(lens, {x, y}));
        ASSERT_TRUE(ideal.has_value()) << x << " " << y;
        EXPECT_LT((*ideal - euroc.Project({x, y, 1.0})).norm(), 1e-5) << x << " " << y;
      }
    }
  }
  // r (1 - .5 r^2) is .544 at most: beyond that no ray arrives, and the way back down is not taken.
  const Lens folding = MakeLens({100, 100, 0, 0, 200, 200}, LensModel::kRadtan, {-0.5, 0, 0, 0}, "");
  EXPECT_TRUE(Undistort(folding, {54.0, 0.0}).has_value());
  EXPECT_LT(Undistort(folding, {54.0, 0.0})->x(), 100.0 * std::sqrt(2.0 / 3.0));
  EXPECT_FALSE(Undistort(folding, {55.0, 0.0}).has_value());
  // r (1 - .3 r^2 + .04 r^4) goes up to .792 at r = 1.41, down, and up again from 1.58: .85 is of r = 1.94,
  // behind the fold.
  const Lens twice = MakeLens({100, 100, 0, 0, 200, 200}, LensModel::kRadtan, {-0.3, 0.04, 0, 0}, "");
  EXPECT_FALSE(Undistort(twice, {85.0, 0.0}).has_value());
  EXPECT_TRUE(Undistort(twice, {75.0, 0.0}).has_value());
  EXPECT_TRUE(ThrowsInputError(
      [] {
        MakeLens({1, 0, 0, 0, 1, 1}, LensModel::kPinhole, {}, "file");
      },
      {"file: fx 1, fy 0"}));
}

// A ray beyond ten focal lengths from the axis, 84.3 deg, is none of a pinhole camera: theta = 1.46 has
// 9, 1.5 has 14.
TEST(Lens, UndistortsUpToTenFocalLengths) {
  const Lens fisheye = MakeLens({100, 100, 0, 0, 400, 400}, LensModel::kFisheye, {0, 0, 0, 0}, "");
  ASSERT_TRUE(Undistort(fisheye, {146.0, 0.0}).has_value());
  EXPECT_NEAR(Undistort(fisheye, {146.0, 0.0})->x(), 100.0 * std::tan(1.46), 1e-3);
  EXPECT_FALSE(Undistort(fisheye, {150.0, 0.0}).has_value());
}

}  // namespace
}  // namespace rcme
