// The contract of every scene in the registry: a new scene is tested by its line there.
#include "simulator/scene_registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <set>

#include "parameters/input_error.h"
#include "simulator/calibration_error.h"
#include "simulator/camera_registry.h"
#include "simulator/motion_registry.h"
#include "simulator/noise_registry.h"
#include "simulator/outlier_model.h"
#include "simulator/outlier_registry.h"
#include "simulator/scene_generator.h"

namespace rcme {
namespace {

Scene Generate(const SceneGenerator& generator, std::uint32_t trial) {
  RandomStream rng({1, 0, trial, 1});
  return generator.Generate(rng);
}

// Generates a few scenes with each of the cameras and each of the motions, and with the usual ones.
class SceneContract : public testing::TestWithParam<SceneEntry> {
 protected:
  // In metres, which needs no search; the parallax that is its default has a test of its own.
  static void SetBaseline(SceneGenerator* generator) {
    FindParameter(generator->Parameters(), "parallax_deg").SetFromText("none");
    FindParameter(generator->Parameters(), "baseline_m").SetFromText("0.005");
  }
  template <typename Action>  // Action(generator)
  static void ForAllCamerasAndMotions(Action action) {
    for (const CameraEntry& cameras : CameraRegistry()) {
      for (const MotionEntry& motion : MotionRegistry()) {
        SCOPED_TRACE(cameras.name + ", " + motion.name);
        SceneGenerator generator(GetParam().name, cameras.name, motion.name);
        if (motion.name == "vanishing_baseline") SetBaseline(&generator);
        action(generator);
        if (testing::Test::HasFatalFailure()) return;
      }
    }
  }
};

// Volume of the parallelepiped of three vectors over the product of their lengths.
double TripleProduct(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const double volume = a.x() * (b.y() * c.z() - b.z() * c.y()) + a.y() * (b.z() * c.x() - b.x() * c.z()) +
                        a.z() * (b.x() * c.y() - b.y() * c.x());
  return volume / (a.norm() * b.norm() * c.norm());
}

// The rays of the two images and the motion between them are coplanar: written with the scalar triple
// product, not with E.
void ExpectSeenByBothCameras(const Scene& scene, const Eigen::Vector3d& point) {
  const Eigen::Vector3d in_cam2 = scene.InCamera2(point);
  ASSERT_GT(point.z(), 0.0);
  ASSERT_GT(in_cam2.z(), 0.0);
  const Eigen::Vector2d x1_px = scene.camera1.Project(point), x2_px = scene.camera2.Project(in_cam2);
  ASSERT_TRUE(scene.camera1.IsInImage(x1_px));
  ASSERT_TRUE(scene.camera2.IsInImage(x2_px));
  const RelativePose& pose = scene.cam2_from_cam1_true;
  const Eigen::Vector3d ray1_in_cam2 = pose.R * scene.camera1.Ray(x1_px);
  ASSERT_LT(std::abs(TripleProduct(scene.camera2.Ray(x2_px), pose.t, ray1_in_cam2)), 1e-12);
}

void ExpectValid(const Scene& scene, size_t num_matches) {
  const Eigen::Matrix3d& R = scene.cam2_from_cam1_true.R;
  EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  EXPECT_GT(R.determinant(), 0.0);
  EXPECT_NEAR(scene.cam2_from_cam1_true.t.norm(), 1.0, 1e-14);
  EXPECT_GE(scene.baseline_m, 0.0);
  EXPECT_TRUE(std::isfinite(scene.baseline_m));
  ASSERT_EQ(scene.points_in_cam1.size(), num_matches);
  for (const Eigen::Vector3d& point : scene.points_in_cam1) {
    ExpectSeenByBothCameras(scene, point);
    if (testing::Test::HasFatalFailure()) return;
  }
}

bool NamesAKey(const std::string& message, SceneGenerator& generator) {
  return std::ranges::any_of(generator.Parameters(), [&](const Parameter& parameter) {
    return message.find(parameter.name()) != std::string::npos;
  });
}

TEST_P(SceneContract, WithItsUsualCamerasAndMotionEveryTrialGivesAValidScene) {
  const SceneGenerator generator(GetParam().name);
  for (std::uint32_t trial = 0; trial < 50; ++trial) {
    ASSERT_NO_THROW(ExpectValid(Generate(generator, trial), 500)) << trial;
    if (HasFatalFailure()) return;
  }
}

// The same from one match to many: parts with a share of one match or less.
TEST_P(SceneContract, TheNumberOfPointsIsWhatIsAskedFor) {
  SceneGenerator generator(GetParam().name);
  for (const int num_matches : {1, 2, 7, 129, 1000}) {
    FindParameter(generator.Parameters(), "num_matches").SetFromText(std::to_string(num_matches));
    for (std::uint32_t trial = 0; trial < 5; ++trial) {
      ExpectValid(Generate(generator, trial), static_cast<size_t>(num_matches));
    }
  }
}

// Combinations that were never meant for each other may admit no scene, but then they say what decides. Fewer
// than one in ten of a scene's trials do.
TEST_P(SceneContract, WithAnyCamerasAndMotionASceneIsValidOrAnErrorNamesTheKeys) {
  int num_trials = 0, num_refused = 0;
  ForAllCamerasAndMotions([&](SceneGenerator& generator) {
    for (std::uint32_t trial = 0; trial < 5; ++trial) {
      ++num_trials;
      try {
        ExpectValid(Generate(generator, trial), 500);
      } catch (const InputError& error) {
        ++num_refused;
        EXPECT_TRUE(NamesAKey(error.what(), generator)) << error.what();
      }
    }
  });
  EXPECT_LT(num_refused, num_trials / 10);
}

TEST_P(SceneContract, IsAPureFunctionOfTheStream) {
  ForAllCamerasAndMotions([&](SceneGenerator& generator) {
    FindParameter(generator.Parameters(), "num_matches").SetFromText("20");
    SceneGenerator another(GetParam().name, generator.cameras(), generator.motion());
    for (const Parameter& parameter : generator.Parameters())
      FindParameter(another.Parameters(), parameter.name()).SetFromText(parameter.Value());
    const Scene other = Generate(generator, 8), a = Generate(generator, 7), b = Generate(another, 7);
    EXPECT_EQ(a.points_in_cam1, b.points_in_cam1);
    EXPECT_EQ(a.cam2_from_cam1_true.R, b.cam2_from_cam1_true.R);
    EXPECT_EQ(a.cam2_from_cam1_true.t, b.cam2_from_cam1_true.t);
    EXPECT_EQ(a.repeat_steps_m, b.repeat_steps_m);
    EXPECT_NE(a.points_in_cam1, other.points_in_cam1);
  });
}

// The correlation of a number with the next: of independent ones normal with standard deviation 1 / sqrt(n).
double LagOneCorrelation(const std::vector<double>& x) {
  double mean = 0.0, variance = 0.0, covariance = 0.0;
  for (const double value : x) mean += value / static_cast<double>(x.size());
  for (size_t i = 0; i < x.size(); ++i) {
    variance += (x[i] - mean) * (x[i] - mean);
    if (i > 0) covariance += (x[i] - mean) * (x[i - 1] - mean);
  }
  return covariance / variance;
}

// Where the last point (of the last part) of each trial is in image 1, and the logarithm of its depth.
template <typename StreamOfTrial>  // std::uint32_t -> std::uint32_t
std::array<std::vector<double>, 3> LastPoints(SceneGenerator& generator, int num_trials,
                                              StreamOfTrial stream) {
  FindParameter(generator.Parameters(), "num_matches").SetFromText("8");
  std::array<std::vector<double>, 3> coordinates;
  for (int trial = 0; trial < num_trials; ++trial) {
    const Scene scene = Generate(generator, stream(static_cast<std::uint32_t>(trial)));
    const Eigen::Vector3d& point = scene.points_in_cam1.back();
    coordinates[0].push_back(point.x() / point.z());
    coordinates[1].push_back(point.y() / point.z());
    coordinates[2].push_back(std::log(point.z()));
  }
  return coordinates;
}

// n = 2,000: three coordinates within 4.5 / sqrt(n) = 0.10, false alarms 2e-5 a scene. Trials whose
// streams are the same two by two have a correlation of 0.5 and are found.
TEST_P(SceneContract, TrialsAreIndependent) {
  constexpr int kTrials = 2000;
  const double bound = 4.5 / std::sqrt(kTrials);
  SceneGenerator generator(GetParam().name);
  for (const std::vector<double>& x : LastPoints(generator, kTrials, [](auto trial) { return trial; })) {
    EXPECT_LT(std::abs(LagOneCorrelation(x)), bound);
  }
  for (const std::vector<double>& x : LastPoints(generator, kTrials, [](auto trial) { return trial / 2; })) {
    EXPECT_GT(LagOneCorrelation(x), 2.0 * bound);
  }
}

// A study names scene, cameras, motion, noise and outliers, and the parameters of all of them are its keys.
TEST_P(SceneContract, ItsParametersHaveNamesOfTheirOwnBesideThoseOfEverythingElse) {
  ForAllCamerasAndMotions([&](SceneGenerator& generator) {
    for (const NoiseEntry& noise_entry : NoiseRegistry()) {
      for (const OutlierEntry& outlier_entry : OutlierRegistry()) {
        const std::unique_ptr<NoiseModel> noise = noise_entry.make();
        OutlierModel outliers(std::shared_ptr<OutlierLaw>(outlier_entry.make()));
        CalibrationError error;
        std::set<std::string> names;
        for (const std::vector<Parameter>& parameters :
             {generator.Parameters(), noise->Parameters(), Parameters(outliers), Parameters(error)}) {
          for (const Parameter& parameter : parameters) {
            EXPECT_TRUE(names.insert(parameter.name()).second)
                << parameter.name() << " with " << noise_entry.name << ", " << outlier_entry.name;
          }
        }
      }
    }
  });
}

TEST_P(SceneContract, ItsParametersAreDocumentedAndSurviveARoundTrip) {
  SceneGenerator generator(GetParam().name);
  for (const Parameter& parameter : generator.Parameters()) {
    EXPECT_FALSE(parameter.doc().empty()) << parameter.name();
    const std::string value = parameter.Value();
    parameter.SetFromText(value);
    EXPECT_EQ(parameter.Value(), value);
  }
}

TEST_P(SceneContract, ItIsDescribedAndItsUsualCamerasAndMotionAreKnown) {
  EXPECT_FALSE(GetParam().doc.empty());
  EXPECT_NO_THROW(FindEntry(CameraRegistry(), "cameras", GetParam().cameras));
  EXPECT_NO_THROW(FindEntry(MotionRegistry(), "motion", GetParam().motion));
}

INSTANTIATE_TEST_SUITE_P(Registry, SceneContract, testing::ValuesIn(SceneRegistry()),
                         [](const auto& scene) { return scene.param.name; });

TEST(SceneRegistry, HoldsEveryKindOfScene) {
  std::vector<std::string> names;
  for (const SceneEntry& scene : SceneRegistry()) names.push_back(scene.name);
  EXPECT_THAT(names, testing::IsSupersetOf({"uniform_volume", "clusters", "image_clusters", "image_region",
                                            "plane", "plane_and_parallax", "two_planes", "corridor", "room",
                                            "street", "far_points", "lattice"}));
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
}

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
