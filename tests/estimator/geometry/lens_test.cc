// Real lenses, against OpenCV.
#include "estimator/geometry/lens.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <opencv2/calib3d.hpp>

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

const Camera kEurocCamera{458.654, 457.296, 367.215, 248.375, 752, 480};

// One of each kind, with every coefficient.
std::vector<Lens> SomeLenses() {
  return {MakeLens(kEurocCamera, LensModel::kRadtan, {-0.28, 0.07, 0.002, -0.003, 0.01}, ""),
          MakeLens(kEurocCamera, LensModel::kRadtan, {0.1, -0.2, 0.001, 0.002, 0.03, 0.05, -0.1, 0.02}, ""),
          MakeLens(kEurocCamera, LensModel::kFisheye, {-0.01, 0.02, -0.01, 0.003}, "")};
}

Eigen::Matrix2d DifferentiateNumerically(const std::function<Eigen::Vector2d(const Eigen::Vector2d&)>& map,
                                         const Eigen::Vector2d& at, double step) {
  Eigen::Matrix2d J;
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector2d d = step * Eigen::Vector2d::Unit(i);
    J.col(i) = (map(at + d) - map(at - d)) / (2.0 * step);
  }
  return J;
}

TEST(Lens, JacobiansAreThoseOfDifferences) {
  for (const Lens& lens : SomeLenses()) {
    for (double x = -0.6; x <= 0.61; x += 0.3) {
      for (double y = -0.4; y <= 0.41; y += 0.2) {
        const Eigen::Vector2d ray(x, y);
        const Eigen::Matrix2d of_projection =
            DifferentiateNumerically([&](const auto& r) { return ProjectThrough(lens, r); }, ray, 1e-6);
        EXPECT_LT((ProjectThroughJacobian(lens, ray) - of_projection).norm(), 1e-6 * of_projection.norm())
            << x << " " << y;
        const Eigen::Vector2d x_px = ProjectThrough(lens, ray);
        const Eigen::Matrix2d of_undistortion =
            DifferentiateNumerically([&](const auto& at) { return *Undistort(lens, at); }, x_px, 1e-3);
        EXPECT_LT((UndistortionJacobian(lens, *Undistort(lens, x_px)) - of_undistortion).norm(), 1e-6)
            << x << " " << y;
      }
    }
  }
}

// cv::undistortPoints and cv::fisheye::undistortPoints, until they move by less than 1e-12: the points, and
// by differences the Jacobian.
TEST(Lens, UndistortsAsOpenCv) {
  const Camera& c = kEurocCamera;
  const cv::Matx33d K(c.fx, 0.0, c.cx, 0.0, c.fy, c.cy, 0.0, 0.0, 1.0);
  const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 200, 1e-12);
  for (const Lens& lens : SomeLenses()) {
    const auto by_opencv = [&](const Eigen::Vector2d& x_px) {
      const std::vector<cv::Point2d> distorted = {{x_px.x(), x_px.y()}};
      std::vector<cv::Point2d> ideal;
      const int num_coefficients = lens.model == LensModel::kFisheye ? 4 : 8;
      const std::vector<double> k(lens.k.begin(), lens.k.begin() + num_coefficients);
      if (lens.model == LensModel::kFisheye)
        cv::fisheye::undistortPoints(distorted, ideal, K, k, cv::Matx33d::eye(), K);
      else
        cv::undistortPoints(distorted, ideal, K, k, cv::Matx33d::eye(), K, until);
      return Eigen::Vector2d(ideal[0].x, ideal[0].y);
    };
    for (double x = 150.0; x <= 600.0; x += 90.0) {
      for (double y = 60.0; y <= 440.0; y += 95.0) {
        const Eigen::Vector2d ideal_px = *Undistort(lens, {x, y});
        EXPECT_LT((ideal_px - by_opencv({x, y})).norm(), 1e-5) << x << " " << y;
        EXPECT_LT(
            (UndistortionJacobian(lens, ideal_px) - DifferentiateNumerically(by_opencv, {x, y}, 0.1)).norm(),
            1e-4)
            << x << " " << y;
      }
    }
  }
}

// theta = r at the focal length 1: along the radius d tan(theta) / d theta = 1 + tan^2, across it tan(theta)
// / theta.
TEST(Lens, MagnifiesByClosedFormsBehindAFisheye) {
  const Lens fisheye = MakeLens({100, 100, 0, 0, 400, 400}, LensModel::kFisheye, {0, 0, 0, 0}, "");
  const double theta = std::acos(-1.0) / 3.0;
  const Eigen::Matrix2d J = UndistortionJacobian(fisheye, *Undistort(fisheye, {100.0 * theta, 0.0}));
  EXPECT_NEAR(J(0, 0), 4.0, 1e-9);
  EXPECT_NEAR(J(1, 1), std::sqrt(3.0) / theta, 1e-9);
  EXPECT_NEAR(std::abs(J(0, 1)) + std::abs(J(1, 0)), 0.0, 1e-12);
}

TEST(Lens, ImagesRaysUpToTheFold) {
  // r (1 - .5 r^2) grows up to r = sqrt(2 / 3).
  const Lens folding = MakeLens({100, 100, 0, 0, 200, 200}, LensModel::kRadtan, {-0.5, 0, 0, 0}, "");
  EXPECT_TRUE(IsImaged(folding, {0.81, 0.0}));
  EXPECT_FALSE(IsImaged(folding, {0.82, 0.0}));
  const Lens fisheye = MakeLens({100, 100, 0, 0, 200, 200}, LensModel::kFisheye, {0, 0, 0, 0}, "");
  EXPECT_TRUE(IsImaged(fisheye, {0.0, 9.9}));
  EXPECT_FALSE(IsImaged(fisheye, {0.0, 10.1}));
  EXPECT_TRUE(IsImaged(MakeLens({100, 100, 0, 0, 200, 200}, LensModel::kPinhole, {}, ""), {20.0, 0.0}));
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
