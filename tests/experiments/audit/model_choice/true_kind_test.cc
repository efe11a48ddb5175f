#include "experiments/audit/model_choice/true_kind.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stats/moments.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

constexpr double kSigmaPx = 0.5;

KindMeasures Measure(const Scene& scene) {
  RandomStream rng({.seed = 1, .purpose = 7});
  return MeasureKind(scene, scene.points_in_cam1, kSigmaPx, 0.01, rng);
}

// Every point moved along its ray onto the plane z = 5 + 0.2 x.
Scene OnAPlane(Scene scene) {
  for (Eigen::Vector3d& X : scene.points_in_cam1) X *= 5.0 / (X.z() - 0.2 * X.x());
  return scene;
}

TEST(TrueKind, OfScenesThatAreClear) {
  const auto kind = [](const Scene& scene) { return ClassifyKind(Measure(scene), 0.1); };
  EXPECT_EQ(kind(TwoCameraScene(200, 0)), TrueKind::kGeneral);
  EXPECT_EQ(kind(OnAPlane(TwoCameraScene(200, 0))), TrueKind::kPlanar);
  EXPECT_EQ(kind(TwoCameraScene(200, 0, 0.0)), TrueKind::kRotationOnly);
  EXPECT_EQ(kind(TwoCameraScene(7, 0)), TrueKind::kBorderline);
  Scene short_baseline = TwoCameraScene(200, 0);
  short_baseline.baseline_m = 1e-4;  // 0.03 px at 2 m
  EXPECT_EQ(kind(short_baseline), TrueKind::kTooLittleParallax);
}

// The exact matches of a rotation lie on it: with their noise one in a hundred lies beyond the 99 % quantile.
TEST(TrueKind, ParallaxOfARotationIsTheLevel) {
  const KindMeasures measures = Measure(TwoCameraScene(200, 0, 0.0));
  EXPECT_NEAR(measures.parallax_share, 0.01, 1e-9);
  EXPECT_EQ(measures.plane_share, 1.0);
  EXPECT_EQ(measures.num_points, 200);
}

// The expected share against shares that the verdict finds in noisy matches of the same scenes, none wrong:
// the mean difference of 60 scenes is within four standard errors of zero, and 0.01 for the rotation that
// the verdict fits to the noise too.
TEST(TrueKind, ExpectsTheShareThatTheVerdictFinds) {
  for (const double baseline_m : {0.015, 0.03}) {  // of points 2 to 8 m away
    Moments found, differences;
    for (std::uint32_t trial = 0; trial < 60; ++trial) {
      Scene scene = TwoCameraScene(200, trial);
      scene.baseline_m = baseline_m;
      const Observation observed = ObserveTwoCameraScene(scene, kSigmaPx, 0.0, trial);
      RandomStream rng({.seed = 1, .trial = trial, .purpose = 8});
      const ModelChoice choice =
          ChooseModel({observed.matches, scene.camera1, scene.camera2, kSigmaPx},
                      {.criterion = ModelCriterion::kAic, .parallax_significance_level = 0.01}, rng);
      ASSERT_EQ(choice.status, MotionStatus::kOk) << choice.message;
      ASSERT_EQ(choice.model, TwoViewModel::kEssential);
      found.Add(choice.parallax_share);
      differences.Add(choice.parallax_share - Measure(scene).parallax_share);
    }
    EXPECT_GT(found.mean(), 0.05) << baseline_m;
    EXPECT_LT(found.mean(), 0.95) << baseline_m;
    EXPECT_NEAR(differences.mean(), 0.0, 0.01 + 4.0 * differences.standard_error()) << baseline_m;
  }
}

TEST(TrueKind, HasABandToEitherSideOfEachBound) {
  const auto kind = [](int n, double baseline_m, double parallax, double plane) {
    return ClassifyKind({n, baseline_m, parallax, plane}, 0.1);
  };
  EXPECT_EQ(kind(7, 0.0, 0.0, 1.0), TrueKind::kBorderline);
  EXPECT_EQ(kind(8, 0.0, 0.0, 1.0), TrueKind::kRotationOnly);
  EXPECT_EQ(kind(8, 1e-9, 0.05, 1.0), TrueKind::kTooLittleParallax);
  EXPECT_EQ(kind(8, 1e-9, 0.051, 1.0), TrueKind::kBorderline);
  EXPECT_EQ(kind(8, 1.0, 0.199, 1.0), TrueKind::kBorderline);
  EXPECT_EQ(kind(8, 1.0, 0.2, 1.0), TrueKind::kPlanar);
  EXPECT_EQ(kind(8, 1.0, 0.2, 0.95), TrueKind::kPlanar);
  EXPECT_EQ(kind(8, 1.0, 0.2, 0.949), TrueKind::kBorderline);
  EXPECT_EQ(kind(8, 1.0, 0.2, 0.751), TrueKind::kBorderline);
  EXPECT_EQ(kind(8, 1.0, 0.2, 0.75), TrueKind::kGeneral);
}

TEST(TrueKind, NamesAreThoseOfTheVerdicts) {
  for (size_t i = 0; i < kSceneVerdicts.size(); ++i) {
    EXPECT_EQ(Name(kTrueKinds[i]), Name(kSceneVerdicts[i]));
  }
  EXPECT_EQ(Name(TrueKind::kBorderline), "borderline");
}

}  // namespace
}  // namespace rcme
