// What the tests of a refined motion (observability.h, motion_chance.h) refuse and what they let pass, on the
// same trials with the tests off and on. In short here; with
//
//   RCME_MOTION_TESTS_TRIALS=1000 estimator_test --gtest_filter='MotionTests.*'
//
// the study of experiments/RESULTS.md, with that number of trials of each condition.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cstdlib>
#include <numbers>

#include "estimator/estimator_registry.h"
#include "estimator/observability.h"
#include "simulator/noise/noise_laws.h"
#include "simulator/observe.h"
#include "simulator/scene_generator.h"
#include "stats/distributions.h"
#include "stats/intervals.h"
#include "tests/test_support/make_ransac.h"

namespace rcme {
namespace {

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

void SetKey(SceneGenerator& scenes, const std::string& key, const std::string& value) {
  FindParameter(scenes.Parameters(), key).SetFromText(value);
}

SceneGenerator MakeScenes(const Condition& c) {
  const bool moves = c.world == World::kParallax || c.world == World::kRandom;
  SceneGenerator scenes("uniform_volume", "", moves ? "general" : "pure_rotation");
  SetKey(scenes, "num_matches", std::to_string(c.num_matches));
  if (c.world == World::kZeroMotion) SetKey(scenes, "max_rotation_deg", "0");
  if (c.world == World::kParallax) SetKey(scenes, "parallax_deg", fmt::format("{}", c.parallax_deg));
  scenes.FixBaseline({1, 14, 0, 5});
  return scenes;
}

Trial MakeTrial(const Condition& c, const SceneGenerator& scenes, std::uint32_t trial) {
  RandomStream scene_rng({1, 14, trial, 1}), noise_rng({1, 14, trial, 2}), outlier_rng({1, 14, trial, 3});
  const Scene scene = scenes.Generate(scene_rng);
  const double outlier_ratio = c.world == World::kRandom ? 1.0 : c.outlier_ratio;
  std::vector<Correspondence> matches =
      Observe(scene, *MakeGaussianNoise(kSigmaPx), OutlierModel(outlier_ratio), noise_rng, outlier_rng)
          .matches;
  return {{std::move(matches), scene.camera1, scene.camera2, kSigmaPx}, scene.cam2_from_cam1_true};
}

RansacOptions Options(bool are_tested) {
  RansacOptions options;
  options.reading = Reading::kRankAware;
  options.observability_significance_level = options.chance_significance_level = are_tested ? 0.001 : 1.0;
  return options;
}

// As in the studies: rotation above 3 deg, direction above 15 deg.
bool IsRight(const MotionEstimate& estimate, const RelativePose& pose_true) {
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

void AddTrial(const std::string& estimator, const Trial& trial, std::uint32_t index, Counts* counts) {
  const auto estimate = [&](bool are_tested) {
    RandomStream rng({1, 14, index, 4});
    return MakeRansac(estimator, Options(are_tested))->Estimate(trial.problem, rng);
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

Counts CountOutcomes(const Condition& condition, const std::string& estimator, int num_trials) {
  const SceneGenerator scenes = MakeScenes(condition);
  Counts counts;
  for (int t = 0; t < num_trials; ++t) {
    const auto index = static_cast<std::uint32_t>(t);
    AddTrial(estimator, MakeTrial(condition, scenes, index), index, &counts);
  }
  return counts;
}

std::string Percent(int count, int n) {
  if (n == 0) return "-";
  const Interval interval = ExactBinomialInterval(count, n);
  return fmt::format("{:.1f} [{:.1f}, {:.1f}] ({})", 100.0 * count / n, 100.0 * interval.lower,
                     100.0 * interval.upper, n);
}

void PrintRow(const Condition& c, const std::string& estimator, const Counts& k) {
  const bool has_direction = c.world == World::kParallax;
  const auto of_right = [&](int count) { return has_direction ? Percent(count, k.right_untested) : "-"; };
  const int by_noise = k.right_refused - k.right_by_chance - k.right_by_rotation;
  fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", c.Name(), c.num_matches, estimator,
             Percent(k.ok_untested, k.num_trials), Percent(k.ok, k.num_trials),
             Percent(k.not_observable, k.num_trials), Percent(k.by_chance, k.num_trials),
             of_right(k.right_by_chance), of_right(k.right_by_rotation), of_right(by_noise),
             has_direction ? Percent(k.wrong_refused, k.wrong_untested) : "-");
  std::fflush(stdout);
}

const char* LongTrials() { return std::getenv("RCME_MOTION_TESTS_TRIALS"); }

std::vector<Condition> AllConditions() {
  std::vector<Condition> all;
  for (const int n : {20, 100, 500, 2000, 20000}) {
    all.push_back({World::kRandom, n, 1.0});
    all.push_back({World::kZeroMotion, n, 0.0});
    for (const double outlier_ratio : {0.0, 0.3, 0.5})
      all.push_back({World::kPureRotation, n, outlier_ratio});
  }
  for (const int n : {20, 100, 500}) {
    for (const double outlier_ratio : {0.0, 0.3, 0.5}) {
      for (const double parallax_deg : {0.2, 1.0, 2.0, 5.0}) {
        all.push_back({World::kParallax, n, outlier_ratio, parallax_deg});
      }
    }
  }
  return all;
}

TEST(MotionTests, Study) {
  if (!LongTrials()) GTEST_SKIP() << "set RCME_MOTION_TESTS_TRIALS";
  const int num_trials = std::atoi(LongTrials());
  fmt::print(
      "| matches | n | estimator | answers without tests, % | answers | direction_not_observable | "
      "not_better_than_chance | of right answers refused | of wrong answers refused |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  for (const Condition& c : AllConditions()) {
    for (const std::string estimator : {"standard", "rcme"}) {
      const int n = c.num_matches > 2000 ? std::max(num_trials / 10, 1) : num_trials;
      PrintRow(c, estimator, CountOutcomes(c, estimator, n));
    }
  }
}

// Coverage of the 95 % region of right answers without the tests, by the noise's share of what determines the
// direction: why kMostNoiseInDirection is what it is.
TEST(MotionTests, CoverageByNoiseShare) {
  if (!LongTrials()) GTEST_SKIP() << "set RCME_MOTION_TESTS_TRIALS";
  constexpr double kEdges[] = {0.05, 0.1, 0.25, 0.4, 0.6, 1e300};
  int num[6] = {}, num_covered[6] = {};
  for (const double parallax_deg : {0.5, 1.0, 2.0}) {
    const Condition condition{World::kParallax, 500, 0.3, parallax_deg};
    const SceneGenerator scenes = MakeScenes(condition);
    for (int t = 0; t < std::atoi(LongTrials()); ++t) {
      const auto index = static_cast<std::uint32_t>(t);
      const Trial trial = MakeTrial(condition, scenes, index);
      RandomStream rng({1, 14, index, 4});
      const MotionEstimate e = MakeRansac("standard", Options(false))->Estimate(trial.problem, rng);
      if (e.status != MotionStatus::kOk || !IsRight(e, trial.pose_true)) continue;
      const double share = NoiseShareOfDirection(trial.problem, e.inliers, e.cam2_from_cam1,
                                                 e.pose_cov.bottomRightCorner<2, 2>());
      const Vector5d error = LocalCoordinates(e.cam2_from_cam1, trial.pose_true);
      const auto bin = static_cast<size_t>(std::ranges::lower_bound(kEdges, share) - kEdges);
      ++num[bin];
      num_covered[bin] += error.dot(e.pose_cov.llt().solve(error)) <= ChiSquareQuantile(5, 0.95);
    }
  }
  for (size_t bin = 0; bin < 6; ++bin) {
    fmt::print("| {} | {} |\n", bin < 5 ? fmt::format("up to {}", kEdges[bin]) : "more",
               Percent(num_covered[bin], num[bin]));
  }
}

// Whatever the estimator, an answer without a motion behind it has probability 0.001 at most; 5 of 300 have
// probability 3e-5 then. Without the tests there are plenty, so that a test which never refuses is caught.
TEST(MotionTests, NoMotionIsRefused) {
  for (const Condition& c : {Condition{World::kPureRotation, 100, 0.3},
                             Condition{World::kZeroMotion, 50, 0.0}, Condition{World::kRandom, 500, 1.0}}) {
    const Counts counts = CountOutcomes(c, "standard", 300);
    EXPECT_LE(counts.ok, 4) << c.Name();
    EXPECT_GE(counts.ok_untested, 60) << c.Name();
    EXPECT_GE(c.world == World::kRandom ? counts.by_chance : counts.not_observable, 60) << c.Name();
  }
}

// Right answers of five degrees of parallax are not refused: 4 of 200 would be, with probability 0.0001, at a
// rate of 0.2 %.
TEST(MotionTests, MotionsAreNotRefused) {
  for (const std::string estimator : {"standard", "rcme"}) {
    const Counts counts = CountOutcomes({World::kParallax, 200, 0.2, 5.0}, estimator, 200);
    EXPECT_GE(counts.right_untested, 150) << estimator;
    EXPECT_LE(counts.right_refused, 3) << estimator;
  }
}

}  // namespace
}  // namespace rcme
