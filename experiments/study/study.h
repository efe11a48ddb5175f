#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/data/data_source.h"
#include "experiments/data/settings.h"
#include "experiments/study/estimator_spec.h"
#include "experiments/study/population.h"
#include "experiments/study/stated_hypothesis.h"
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

// One data setting, or one option of one estimator ("opencv_usac.threshold_sigma"), and the values it takes.
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
  // Not empty: every draw of it is a condition, or as many as the factors make of it.
  std::optional<Population> population;
  std::vector<EstimatorSpec> estimators;
  FailureBounds failure;
  std::vector<StatedHypothesis> hypotheses;  // what its run is expected to show; no run depends on them
  std::optional<Tuning> tuning;              // what `rcme tune` does with it
};

// The parts of an Ademp with their keys, in order.
std::vector<std::pair<std::string, std::string*>> Parts(Ademp& ademp);

// What a row of the design has a level of: of a population kDrawFactor and its keys, then the factors.
std::vector<std::string> FactorNames(const Study& study);

// One row per condition, one level per factor, the first factor slowest; of a population those of the draws
// that meet its restrictions. Throws InputError: more than kMaxConditions; a one-at-a-time design whose
// `data` lacks a factor's base value.
std::vector<std::vector<std::string>> DesignRows(const Study& study);
// Those of the factors alone, and the levels of a draw with such a row.
std::vector<std::vector<std::string>> FactorRows(const Study& study);
std::vector<std::string> JoinLevels(const PopulationDraw& draw, const std::vector<std::string>& of_factors);

// The settings of a condition: those of `data`, then its levels but for options of estimators.
Settings CombineSettings(const Study& study, const std::vector<std::string>& levels);

// Whether a factor is an option of an estimator: LABEL.OPTION.
bool IsEstimatorOption(const std::string& factor);

// The estimators of a condition: those of the study with the options that are levels of it.
std::vector<EstimatorSpec> ResolveEstimators(const Study& study, const std::vector<std::string>& levels);

// Throws InputError where options of estimators are factors; `who` cannot take them.
void RequireFixedOptions(const Study& study, const std::string& who);

}  // namespace rcme
