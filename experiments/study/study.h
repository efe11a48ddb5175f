#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/data/data_source.h"
#include "experiments/data/settings.h"
#include "experiments/study/estimator_spec.h"
#include "experiments/study/tuning.h"

namespace rcme {

// When a returned motion counts as failed.
struct FailureBounds {
  double max_rotation_error_deg = 3.0;
  double max_direction_error_deg = 15.0;
};
std::vector<Parameter> Parameters(FailureBounds& bounds);

inline constexpr size_t kMaxConditions = 100'000;  // of a study
inline constexpr int kMaxRepeatsPerScene = 10'000;

// One data setting and the values it takes.
struct Factor {
  std::string key;
  std::vector<std::string> levels;
};

enum class Design {
  kFullFactorial,  // all combinations of all factors
  kOneAtATime,     // the values in `data`, and each level of each factor with the other factors as in `data`
};

// What a reader of a simulation study wants to know (Morris, White & Crowther 2019), in the study's own
// words.
struct Ademp {
  std::string aims, data, estimands, methods, performance;
};

// A simulation study: what is varied, what is compared, how often, from which seed.
struct Study {
  std::string name;
  std::string description;
  std::optional<Ademp> ademp;
  std::uint64_t seed = 1;
  int trials = 100;  // per condition; for a folder of pairs, passes over each pair
  Settings data;     // fixed settings
  // One set of scenes, noise and outliers for all conditions whose scene is shaped alike, so that differences
  // between levels of the outlier ratio or the noise level are paired.
  bool common_scenes = false;
  // Each scene, with its noise and outliers, is met by so many trials, one after the other, that differ in
  // the samples the estimators draw: trial k is of scene k / repeats_per_scene.
  int repeats_per_scene = 1;
  Design design = Design::kFullFactorial;
  std::vector<Factor> factors;
  std::vector<EstimatorSpec> estimators;
  FailureBounds failure;
  std::optional<Tuning> tuning;  // what `rcme tune` does with it
};

// The parts of an Ademp with their keys, in order.
std::vector<std::pair<std::string, std::string*>> Parts(Ademp& ademp);

// One row per condition, one level per factor, the first factor slowest. Throws InputError: more than
// kMaxConditions; a one-at-a-time design whose `data` lacks a factor's base value.
std::vector<std::vector<std::string>> DesignRows(const Study& study);

// The settings of a condition: those of `data`, then its levels.
Settings SettingsOf(const Study& study, const std::vector<std::string>& levels);

}  // namespace rcme
