// The contract of every scene in the registry: a new scene is tested by its line there.
#include "simulator/scene_registry.h"

#include <gtest/gtest.h>

#include <set>

#include "parameters/input_error.h"

namespace rcme {
namespace {

class SceneContract : public testing::TestWithParam<SceneEntry> {
 protected:
  static Scene Generate(const SceneModel& model, std::uint32_t trial) {
    RandomStream rng({1, 0, trial, 1});
    return model.Generate(rng);
  }
};

TEST_P(SceneContract, EveryPointIsInFrontOfBothCamerasAndInBothImages) {
  const std::unique_ptr<SceneModel> model = GetParam().make();
  for (std::uint32_t trial = 0; trial < 50; ++trial) {
    const Scene scene = Generate(*model, trial);
    ASSERT_FALSE(scene.points_in_cam1.empty());
    for (const Eigen::Vector3d& point : scene.points_in_cam1) {
      const Eigen::Vector3d in_cam2 = scene.InCamera2(point);
      ASSERT_GT(point.z(), 0.0);
      ASSERT_GT(in_cam2.z(), 0.0);
      ASSERT_TRUE(scene.camera1.IsInImage(scene.camera1.Project(point)));
      ASSERT_TRUE(scene.camera2.IsInImage(scene.camera2.Project(in_cam2)));
    }
  }
}

TEST_P(SceneContract, TheMotionIsARotationAndAUnitDirection) {
  const std::unique_ptr<SceneModel> model = GetParam().make();
  for (std::uint32_t trial = 0; trial < 50; ++trial) {
    const Scene scene = Generate(*model, trial);
    const Eigen::Matrix3d& R = scene.cam2_from_cam1_true.R;
    EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(scene.cam2_from_cam1_true.t.norm(), 1.0, 1e-14);
    EXPECT_GT(scene.baseline_m, 0.0);
  }
}

// Rays of the two images, the motion between them: coplanar. Written with the scalar triple product, not with
// E.
TEST_P(SceneContract, TheImagesSatisfyTheEpipolarConstraintBeforeNoise) {
  const std::unique_ptr<SceneModel> model = GetParam().make();
  for (std::uint32_t trial = 0; trial < 50; ++trial) {
    const Scene scene = Generate(*model, trial);
    for (const Eigen::Vector3d& point : scene.points_in_cam1) {
      const Eigen::Vector3d ray1 = scene.camera1.Ray(scene.camera1.Project(point));
      const Eigen::Vector3d ray2 = scene.camera2.Ray(scene.camera2.Project(scene.InCamera2(point)));
      const RelativePose& pose = scene.cam2_from_cam1_true;
      const Eigen::Vector3d ray1_in_cam2 = pose.R * ray1;
      const double triple = ray2.x() * (pose.t.y() * ray1_in_cam2.z() - pose.t.z() * ray1_in_cam2.y()) +
                            ray2.y() * (pose.t.z() * ray1_in_cam2.x() - pose.t.x() * ray1_in_cam2.z()) +
                            ray2.z() * (pose.t.x() * ray1_in_cam2.y() - pose.t.y() * ray1_in_cam2.x());
      ASSERT_LT(std::abs(triple), 1e-12);
    }
  }
}

TEST_P(SceneContract, IsAPureFunctionOfTheStream) {
  const std::unique_ptr<SceneModel> model = GetParam().make();
  const Scene a = Generate(*model, 7), b = Generate(*model, 7), c = Generate(*model, 8);
  EXPECT_EQ(a.points_in_cam1, b.points_in_cam1);
  EXPECT_EQ(a.cam2_from_cam1_true.R, b.cam2_from_cam1_true.R);
  EXPECT_NE(a.points_in_cam1, c.points_in_cam1);
}

TEST_P(SceneContract, ItsParametersHaveNamesOfTheirOwnAndSurviveARoundTrip) {
  const std::unique_ptr<SceneModel> model = GetParam().make();
  std::set<std::string> names;
  for (const Parameter& parameter : model->Parameters()) {
    EXPECT_TRUE(names.insert(parameter.name()).second) << parameter.name();
    EXPECT_FALSE(parameter.doc().empty()) << parameter.name();
    const std::string value = parameter.Value();
    parameter.SetFromText(value);
    EXPECT_EQ(parameter.Value(), value);
  }
}

INSTANTIATE_TEST_SUITE_P(Registry, SceneContract, testing::ValuesIn(SceneRegistry()),
                         [](const auto& scene) { return scene.param.name; });

TEST(FindScene, KnowsTheRegistryAndNothingElse) {
  EXPECT_NE(FindScene("uniform_volume"), nullptr);
  EXPECT_EQ(FindScene("no_such_scene"), nullptr);
}

}  // namespace
}  // namespace rcme
