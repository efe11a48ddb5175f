// The contract of every scene in the registry: a new scene is tested by its line there.
#include "simulator/scene_registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "parameters/input_error.h"
#include "simulator/scene_generator.h"

namespace rcme {
namespace {

class SceneContract : public testing::TestWithParam<SceneEntry> {
 protected:
  static Scene Generate(std::uint32_t trial) {
    const SceneGenerator generator(GetParam().name);
    RandomStream rng({1, 0, trial, 1});
    return generator.Generate(rng);
  }
};

TEST_P(SceneContract, EveryPointIsInFrontOfBothCamerasAndInBothImages) {
  for (std::uint32_t trial = 0; trial < 50; ++trial) {
    const Scene scene = Generate(trial);
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
  for (std::uint32_t trial = 0; trial < 50; ++trial) {
    const Scene scene = Generate(trial);
    const Eigen::Matrix3d& R = scene.cam2_from_cam1_true.R;
    EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(scene.cam2_from_cam1_true.t.norm(), 1.0, 1e-14);
    EXPECT_GT(scene.baseline_m, 0.0);
  }
}

// Rays of the two images, the motion between them: coplanar. Written with the scalar triple product, not with
// E.
TEST_P(SceneContract, TheImagesSatisfyTheEpipolarConstraintBeforeNoise) {
  for (std::uint32_t trial = 0; trial < 50; ++trial) {
    const Scene scene = Generate(trial);
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
  const Scene a = Generate(7), b = Generate(7), c = Generate(8);
  EXPECT_EQ(a.points_in_cam1, b.points_in_cam1);
  EXPECT_EQ(a.cam2_from_cam1_true.R, b.cam2_from_cam1_true.R);
  EXPECT_NE(a.points_in_cam1, c.points_in_cam1);
}

TEST_P(SceneContract, ItsParametersHaveNamesOfTheirOwnAndSurviveARoundTrip) {
  SceneGenerator generator(GetParam().name);
  std::set<std::string> names;
  for (const Parameter& parameter : generator.Parameters()) {
    EXPECT_TRUE(names.insert(parameter.name()).second) << parameter.name();
    EXPECT_FALSE(parameter.doc().empty()) << parameter.name();
    const std::string value = parameter.Value();
    parameter.SetFromText(value);
    EXPECT_EQ(parameter.Value(), value);
  }
}

INSTANTIATE_TEST_SUITE_P(Registry, SceneContract, testing::ValuesIn(SceneRegistry()),
                         [](const auto& scene) { return scene.param.name; });

TEST(FindEntry, KnowsTheRegistryAndListsItOtherwise) {
  EXPECT_EQ(FindEntry(SceneRegistry(), "scene", "uniform_volume").name, "uniform_volume");
  try {
    FindEntry(SceneRegistry(), "scene", "no_such_scene");
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("scene: 'no_such_scene' is not allowed"));
    EXPECT_THAT(error.what(), testing::HasSubstr("uniform_volume"));
  }
}

}  // namespace
}  // namespace rcme
