// A parallax that is asked for is what is measured: mean over trials of the median over points.
#include "simulator/baseline_of_parallax.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulator/camera_registry.h"
#include "simulator/motion_registry.h"
#include "simulator/scene_generator.h"
#include "simulator/scene_registry.h"
#include "simulator/severity/parallax.h"
#include "stats/moments.h"
#include "stats/order_statistic.h"
#include "tests/test_support/expect_input_error.h"

namespace rcme {
namespace {

constexpr StreamName kPilot = {.purpose = 8};

// Of fresh scenes with twice the matches of the pilot ones.
Moments MedianParallaxesDeg(const SceneGenerator& scenes, std::uint32_t num_scenes) {
  Moments medians;
  for (std::uint32_t trial = 0; trial < num_scenes; ++trial) {
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 1});
    const Scene scene = scenes.Generate(rng);
    std::vector<double> angles_deg = ParallaxesDeg(scene, scene.points_in_cam1);
    medians.Add(ComputeQuantile(angles_deg, 0.5));
  }
  return medians;
}

void ExpectParallax(const std::string& scene, const std::string& cameras, const std::string& motion,
                    const std::string& wanted_deg) {
  SceneGenerator scenes(scene, cameras, motion);
  FindParameter(scenes.Parameters(), "parallax_deg").SetFromText(wanted_deg);
  FindParameter(scenes.Parameters(), "num_matches").SetFromText("200");
  // With half of the points far away, as by default, the median is one of those.
  if (scene == "far_points") FindParameter(scenes.Parameters(), "far_share").SetFromText("0.2");
  scenes.FixBaseline(kPilot);
  const Moments measured = MedianParallaxesDeg(scenes, 300);
  // Four standard errors of what is measured, 1.5 % for the pilot scenes, and the bias of a median of so few.
  const double wanted = std::stod(wanted_deg);
  EXPECT_NEAR(measured.mean(), wanted, 4.0 * measured.standard_error() + 0.025 * wanted)
      << scene << ", " << scenes.cameras() << ", " << scenes.motion();
  EXPECT_LT(measured.standard_error(), 0.05 * wanted) << "no power";
}

TEST(ParallaxAskedFor, IsMeasuredInEveryScene) {
  for (const SceneEntry& scene : SceneRegistry()) ExpectParallax(scene.name, "", "", "1.5");
}

TEST(ParallaxAskedFor, IsMeasuredWithEveryCameras) {
  for (const CameraEntry& cameras : CameraRegistry()) {
    for (const char* scene : {"uniform_volume", "room"}) ExpectParallax(scene, cameras.name, "", "1.5");
  }
}

TEST(ParallaxAskedFor, IsMeasuredWithEveryMotionThatTranslates) {
  for (const MotionEntry& motion : MotionRegistry()) {
    if (motion.make()->MutableBaseline() == nullptr) continue;
    ExpectParallax("uniform_volume", "", motion.name, "3");
  }
  for (const char* wanted_deg : {"0.05", "12"}) {
    ExpectParallax("uniform_volume", "", "general", wanted_deg);
    ExpectParallax("uniform_volume", "", "sideways", wanted_deg);
  }
}

TEST(ParallaxAskedFor, IsRefusedWhereNoBaselineGivesIt) {
  SceneGenerator scenes("uniform_volume", "", "forward");
  FindParameter(scenes.Parameters(), "parallax_deg").SetFromText("60");
  EXPECT_TRUE(ThrowsInputError([&] { scenes.FixBaseline(kPilot); },
                               {"parallax_deg: 60 is not allowed", "motion forward", "at most about"}));
  SceneGenerator far("far_points");
  FindParameter(far.Parameters(), "parallax_deg").SetFromText("1");
  EXPECT_TRUE(ThrowsInputError([&] { far.FixBaseline(kPilot); }, {"parallax_deg: 1 is not", "far_share"}));
  SceneGenerator rotation("uniform_volume", "", "pure_rotation");
  for (const Parameter& parameter : rotation.Parameters()) EXPECT_NE(parameter.name(), "parallax_deg");
}

TEST(ParallaxAskedFor, InMetresNothingIsFixed) {
  SceneGenerator scenes("uniform_volume");
  scenes.FixBaseline(kPilot);
  EXPECT_TRUE(std::isnan(scenes.BaselineOfParallax()));
  RandomStream rng({.seed = 1});
  EXPECT_EQ(scenes.Generate(rng).baseline_m, 0.5);
}

// A sideways move seen at a depth of 5 m: 2 atan(b / 10).
TEST(FindBaseline, InvertsAKnownParallax) {
  const auto parallax_deg = [](double b) -> std::optional<double> {
    return 2.0 * std::atan(b / 10.0) * 180.0 / std::numbers::pi;
  };
  for (const double wanted : {1e-6, 0.05, 4.0, 90.0}) {
    const BaselineSearch found = FindBaseline(parallax_deg, wanted);
    ASSERT_TRUE(found.baseline_m);
    EXPECT_NEAR(*parallax_deg(*found.baseline_m), wanted, 1.1e-3 * wanted);
  }
}

TEST(FindBaseline, SaysTheGreatestWhereNoneIsLongEnough) {
  const auto up_to_three_metres = [](double b) -> std::optional<double> {
    return b <= 3.0 ? std::optional<double>(2.0 * b) : std::nullopt;
  };
  EXPECT_NEAR(FindBaseline(up_to_three_metres, 5.0).baseline_m.value(), 2.5, 0.003);
  const BaselineSearch none = FindBaseline(up_to_three_metres, 7.0);
  EXPECT_FALSE(none.baseline_m);
  EXPECT_NEAR(none.greatest_deg, 6.0, 0.001);
  const BaselineSearch saturated = FindBaseline([](double) { return std::optional<double>(2.0); }, 3.0);
  EXPECT_FALSE(saturated.baseline_m);
  EXPECT_EQ(FindBaseline([](double) { return std::optional<double>(); }, 3.0).greatest_deg, 0.0);
}

}  // namespace
}  // namespace rcme
