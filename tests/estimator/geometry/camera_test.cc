#include "estimator/geometry/camera.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>

#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

TEST(Camera, KIsTheTextbookMatrix) {
  Eigen::Matrix3d K;
  K << 700.0, 0.0, 330.0, 0.0, 650.0, 235.0, 0.0, 0.0, 1.0;
  EXPECT_EQ(TestCamera1().K(), K);
}

TEST(Camera, InverseKIsTheInverse) {
  for (const Camera& camera : {TestCamera1(), TestCamera2()}) {
    EXPECT_LT((camera.K() * camera.InverseK() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  }
}

TEST(Camera, RayIsInverseKTimesPixel) {
  const Camera camera = TestCamera2();
  const Eigen::Vector2d pixel(17.25, 501.5);
  EXPECT_LT((camera.Ray(pixel) - camera.InverseK() * pixel.homogeneous()).norm(), 1e-14);
  EXPECT_EQ(camera.Ray(pixel).z(), 1.0);
  EXPECT_EQ(camera.Ray({camera.cx, camera.cy}), Eigen::Vector3d(0.0, 0.0, 1.0));
}

TEST(Camera, ProjectAndRayAreInverse) {
  RandomStream rng({.seed = 1, .purpose = 40});
  for (int i = 0; i < 100; ++i) {
    const Camera camera = i % 2 == 0 ? TestCamera1() : TestCamera2();
    const Eigen::Vector2d pixel(rng.Uniform(-100.0, 900.0), rng.Uniform(-100.0, 700.0));
    const double depth = rng.Uniform(0.01, 100.0);
    EXPECT_LT((camera.Project(depth * camera.Ray(pixel)) - pixel).norm(), 1e-10);
  }
}

TEST(Camera, ProjectByHand) {
  // x right, y down, z forward: (1, -2, 4) with f = (700, 650), c = (330, 235).
  EXPECT_EQ(TestCamera1().Project({1.0, -2.0, 4.0}), Eigen::Vector2d(505.0, -90.0));
}

TEST(Camera, ImageBorderIsHalfAPixelOutside) {
  const Camera camera = TestCamera1();  // 640 x 480
  EXPECT_TRUE(camera.IsInImage({-0.5, -0.5}));
  EXPECT_TRUE(camera.IsInImage({639.5, 479.5}));
  EXPECT_FALSE(camera.IsInImage({-0.51, 100.0}));
  EXPECT_FALSE(camera.IsInImage({639.51, 100.0}));
  EXPECT_FALSE(camera.IsInImage({100.0, -0.51}));
  EXPECT_FALSE(camera.IsInImage({100.0, 479.51}));
  EXPECT_FALSE(camera.IsInImage({std::numeric_limits<double>::quiet_NaN(), 100.0}));
}

TEST(Camera, ValidOnlyIfEveryNumberMakesSense) {
  EXPECT_TRUE(TestCamera1().IsValid());
  EXPECT_FALSE(Camera().IsValid()) << "the default must be filled in";
  for (const double bad :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (double Camera::*field : {&Camera::fx, &Camera::fy}) {
      Camera camera = TestCamera1();
      camera.*field = bad;
      EXPECT_FALSE(camera.IsValid()) << bad;
    }
  }
  for (double Camera::*field : {&Camera::cx, &Camera::cy}) {
    Camera camera = TestCamera1();
    camera.*field = -1000.0;  // a principal point may lie outside the image
    EXPECT_TRUE(camera.IsValid());
    camera.*field = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(camera.IsValid());
  }
  for (int Camera::*field : {&Camera::width, &Camera::height}) {
    Camera camera = TestCamera1();
    camera.*field = 0;
    EXPECT_FALSE(camera.IsValid());
  }
}

}  // namespace
}  // namespace rcme
