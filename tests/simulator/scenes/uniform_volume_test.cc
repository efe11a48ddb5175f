#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "parameters/input_error.h"
#include "simulator/cameras/camera_models.h"
#include "simulator/motions/motions.h"
#include "simulator/scene_generator.h"
#include "tests/test_support/goodness_of_fit.h"

namespace rcme {
namespace {

using testing::HasSubstr;

void Set(SceneGenerator& model, const std::string& name, const std::string& value) {
  FindParameter(model.Parameters(), name).SetFromText(value);
}

// With no rotation and a vanishing baseline image 2 sees all that image 1 sees, so the law is the
// unconditional one. Kolmogorov-Smirnov at 1e-4 from 20,000 points; a coordinate with 3 % of its range
// missing (D = 0.03) would give sqrt(n) D = 4.2, p < 1e-14.
TEST(UniformVolume, ImageAndDepthAreUniform) {
  SceneGenerator model("uniform_volume");
  Set(model, "num_matches", "20000");
  Set(model, "max_rotation_deg", "0");
  Set(model, "baseline_m", "1e-9");
  RandomStream rng({1, 0, 0, 1});
  const Scene scene = model.Generate(rng);
  std::vector<double> x, y, depth;
  for (const Eigen::Vector3d& point : scene.points_in_cam1) {
    const Eigen::Vector2d pixel = scene.camera1.Project(point);
    x.push_back((pixel.x() + 0.5) / 640.0);
    y.push_back((pixel.y() + 0.5) / 480.0);
    depth.push_back((point.z() - 2.0) / 6.0);
  }
  const auto uniform = [](double u) { return std::clamp(u, 0.0, 1.0); };
  EXPECT_GT(TestKolmogorovSmirnov(x, uniform).p_value, 1e-4);
  EXPECT_GT(TestKolmogorovSmirnov(y, uniform).p_value, 1e-4);
  EXPECT_GT(TestKolmogorovSmirnov(depth, uniform).p_value, 1e-4);
  // The same test sees a depth that is uniform in its square instead.
  for (double& d : depth) d = d * d;
  EXPECT_LT(TestKolmogorovSmirnov(depth, uniform).p_value, 1e-10);
}

struct MotionBounds {
  const char *max_rotation_deg, *baseline_m;
};

// The points of the model with its default cameras, one candidate after the other.
std::vector<Eigen::Vector3d> DrawPointByPoint(size_t num_matches, const MotionBounds& bounds,
                                              RandomStream& rng) {
  const Camera camera = MakePinhole()->Make().first;
  const std::unique_ptr<MotionModel> motion_model = MakeGeneralMotion();
  FindParameter(motion_model->Parameters(), "max_rotation_deg").SetFromText(bounds.max_rotation_deg);
  FindParameter(motion_model->Parameters(), "baseline_m").SetFromText(bounds.baseline_m);
  const Motion motion = motion_model->Draw(rng);
  const RelativePose& pose = motion.cam2_from_cam1;
  std::vector<Eigen::Vector3d> points;
  while (points.size() < num_matches) {
    const double y_px = rng.Uniform(-0.5, camera.height - 0.5);
    const double x_px = rng.Uniform(-0.5, camera.width - 0.5);
    const double depth_m = rng.Uniform(2.0, 8.0);
    const Eigen::Vector3d point = depth_m * camera.Ray({x_px, y_px});
    const Eigen::Vector3d in_cam2 = pose.R * point + motion.baseline_m * pose.t;
    if (in_cam2.z() > 0.0 && camera.IsInImage(camera.Project(in_cam2))) points.push_back(point);
  }
  return points;
}

// To the bit, whether most candidates are accepted or (at 25 deg) few. A candidate within rounding error of
// the image border may be judged otherwise; among these 100,000 there is none.
TEST(UniformVolume, IsThePlainLoopOverCandidates) {
  for (const MotionBounds& motion : {MotionBounds{"10", "0.5"}, MotionBounds{"25", "1"}}) {
    for (const int num_matches : {1, 7, 128, 129, 500}) {
      SceneGenerator model("uniform_volume");
      Set(model, "num_matches", std::to_string(num_matches));
      Set(model, "max_rotation_deg", motion.max_rotation_deg);
      Set(model, "baseline_m", motion.baseline_m);
      for (std::uint32_t trial = 0; trial < 40; ++trial) {
        RandomStream rng({1, 0, trial, 1}), plain_rng({1, 0, trial, 1});
        ASSERT_EQ(model.Generate(rng).points_in_cam1,
                  DrawPointByPoint(static_cast<size_t>(num_matches), motion, plain_rng));
      }
    }
  }
}

TEST(UniformVolume, AnImpossibleRequestNamesTheKeysAndEnds) {
  SceneGenerator model("uniform_volume");
  Set(model, "focal_px", "1000000");  // the disparity is 60,000 px and more
  RandomStream rng({1, 0, 0, 1});
  try {
    model.Generate(rng);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("baseline_m"));
    EXPECT_THAT(error.what(), HasSubstr("max_rotation_deg"));
  }
}

TEST(UniformVolume, AnEmptyDepthRangeIsAnError) {
  SceneGenerator model("uniform_volume");
  Set(model, "min_depth_m", "9");
  RandomStream rng({1, 0, 0, 1});
  EXPECT_THROW(model.Generate(rng), InputError);
}

}  // namespace
}  // namespace rcme
