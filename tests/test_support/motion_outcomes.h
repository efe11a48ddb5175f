// What the tests of a refined motion (observability.h, motion_chance.h) refuse and what they let pass, on the
// same trials with the tests off and on: for the test in short (motion_tests_study_test.cc) and the study of
// results/motion_tests (tests/studies/motion_tests_main.cc).
#pragma once

#include <fmt/format.h>

#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "estimator/estimators/rcme.h"
#include "estimator/estimators/standard.h"
#include "estimator/ransac_options.h"
#include "simulator/noise/noise_laws.h"
#include "simulator/observe.h"
#include "simulator/scene_generator.h"

namespace rcme::motion_tests {

constexpr double kSigmaPx = 0.5;

enum class World { kRandom, kZeroMotion, kPureRotation, kParallax };
struct Condition {
  World world;
  int num_matches;
  double outlier_ratio;
  double parallax_deg = 0.0;

  std::string Name() const {
    switch (world) {
      case World::kRandom:
        return "random matches";
      case World::kZeroMotion:
        return fmt::format("zero motion, {:.0f} % outliers", 100.0 * outlier_ratio);
      case World::kPureRotation:
        return fmt::format("pure rotation, {:.0f} % outliers", 100.0 * outlier_ratio);
      case World::kParallax:
        break;
    }
    return fmt::format("{} deg of parallax, {:.0f} % outliers", parallax_deg, 100.0 * outlier_ratio);
  }
};

struct Trial {
  MotionProblem problem;
  RelativePose pose_true;
};

inline void SetKey(SceneGenerator& scenes, const std::string& key, const std::string& value) {
  FindParameter(scenes.Parameters(), key).SetFromText(value);
}

inline SceneGenerator MakeScenes(const Condition& c) {
  const bool moves = c.world == World::kParallax || c.world == World::kRandom;
  SceneGenerator scenes("uniform_volume", "", moves ? "general" : "pure_rotation");
  SetKey(scenes, "num_matches", std::to_string(c.num_matches));
  if (c.world == World::kZeroMotion) SetKey(scenes, "max_rotation_deg", "0");
  if (c.world == World::kParallax) SetKey(scenes, "parallax_deg", fmt::format("{}", c.parallax_deg));
  scenes.FixBaseline({1, 14, 0, 5});
  return scenes;
}

inline Trial MakeTrial(const Condition& c, const SceneGenerator& scenes, std::uint32_t trial) {
  RandomStream scene_rng({1, 14, trial, 1}), noise_rng({1, 14, trial, 2}), outlier_rng({1, 14, trial, 3});
  const Scene scene = scenes.Generate(scene_rng);
  const double outlier_ratio = c.world == World::kRandom ? 1.0 : c.outlier_ratio;
  std::vector<Correspondence> matches =
      Observe(scene, *MakeGaussianNoise(kSigmaPx), OutlierModel(outlier_ratio), noise_rng, outlier_rng)
          .matches;
  return {{std::move(matches), scene.camera1, scene.camera2, kSigmaPx}, scene.cam2_from_cam1_true};
}

inline RansacOptions Options(bool are_tested) {
  RansacOptions options;
  options.reading = Reading::kRankAware;
  options.observability_significance_level = options.chance_significance_level = are_tested ? 0.001 : 1.0;
  return options;
}

// "standard" or "rcme".
inline std::unique_ptr<MotionEstimator> MakeEstimator(const std::string& name, bool are_tested) {
  if (name == "standard") return MakeStandard(Options(are_tested));
  return MakeRcme(Options(are_tested), SampleTest::kOn);
}

// As in the studies: rotation above 3 deg, direction above 15 deg.
inline bool IsRight(const MotionEstimate& estimate, const RelativePose& pose_true) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  return RotationAngleBetween(estimate.cam2_from_cam1.R, pose_true.R) <= 3.0 * kDegree &&
         AngleBetween(estimate.cam2_from_cam1.t, pose_true.t) <= 15.0 * kDegree;
}

struct Counts {
  int num_trials = 0;
  int ok_untested = 0, ok = 0, not_observable = 0, by_chance = 0;
  // Of the answers without tests: right, and of these refused with them, by which; and wrong.
  int right_untested = 0, right_refused = 0, right_by_chance = 0, right_by_rotation = 0;
  int wrong_untested = 0, wrong_refused = 0;
};

inline void AddTrial(const std::string& estimator, const Trial& trial, std::uint32_t index, Counts* counts) {
  const auto estimate = [&](bool are_tested) {
    RandomStream rng({1, 14, index, 4});
    return MakeEstimator(estimator, are_tested)->Estimate(trial.problem, rng);
  };
  const MotionEstimate untested = estimate(false), tested = estimate(true);
  ++counts->num_trials;
  const bool is_ok = tested.status == MotionStatus::kOk;
  counts->ok += is_ok;
  counts->not_observable += tested.status == MotionStatus::kDirectionNotObservable;
  counts->by_chance += tested.status == MotionStatus::kNotBetterThanChance;
  if (untested.status != MotionStatus::kOk) return;
  ++counts->ok_untested;
  const bool is_right = IsRight(untested, trial.pose_true);
  ++(is_right ? counts->right_untested : counts->wrong_untested);
  if (is_ok) return;
  ++(is_right ? counts->right_refused : counts->wrong_refused);
  if (!is_right) return;
  counts->right_by_chance += tested.status == MotionStatus::kNotBetterThanChance;
  counts->right_by_rotation += tested.message.starts_with("a rotation alone");
}

inline Counts CountOutcomes(const Condition& condition, const std::string& estimator, int num_trials) {
  const SceneGenerator scenes = MakeScenes(condition);
  Counts counts;
  for (int t = 0; t < num_trials; ++t) {
    const auto index = static_cast<std::uint32_t>(t);
    AddTrial(estimator, MakeTrial(condition, scenes, index), index, &counts);
  }
  return counts;
}

}  // namespace rcme::motion_tests
