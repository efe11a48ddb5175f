#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/data/data_source.h"
#include "experiments/study/estimator_spec.h"
#include "experiments/study/population.h"
#include "experiments/study/stated_hypothesis.h"
#include "experiments/study/tuning.h"

namespace rcme {

// A returned motion with a greater error counts as failed.
struct FailureBounds {
  double max_rotation_error_deg = 3.0;
  double max_direction_error_deg = 15.0;
};
std::vector<Parameter> Parameters(FailureBounds& bounds);

inline constexpr size_t kMaxConditions = 100'000;  // of a study
inline constexpr int kMaxRepeatsPerScene = 10'000;

// What varies: a data setting, or an option of an estimator ("opencv_usac.threshold_sigma"), and its values.
struct Factor {
  std::string key;
  std::vector<std::string> levels;
};

enum class Design {
  kFullFactorial,  // all combinations of all factors
  kOneAtATime,     // the values in `data`, then each other level of each factor with the other factors as in
                   // `data`
};

// The plan of a simulation study as text, structured by ADEMP (Morris, White & Crowther 2019).
struct Ademp {
  std::string aims, data, estimands, methods, performance;
};

// A simulation study: what varies, which estimators are compared, how many trials, which seed.
struct Study {
  std::string name;
  std::string description;
  std::optional<Ademp> ademp;
  std::uint64_t seed = 1;
  int trials = 100;  // per condition; for a folder of pairs, passes over each pair
  Settings data;     // fixed settings
  // Conditions whose settings for the scene agree share scenes, noise and outliers, so differences between
  // levels of the outlier ratio or the noise level are paired.
  bool common_scenes = false;
  // The number of consecutive trials that share a scene with its noise and outliers. They differ in the
  // samples that the estimators draw; trial k has scene k / repeats_per_scene.
  int repeats_per_scene = 1;
  Design design = Design::kFullFactorial;
  std::vector<Factor> factors;
  // If set, every draw is a condition, or one condition for each combination of the factors.
  std::optional<Population> population;
  std::vector<EstimatorSpec> estimators;
  FailureBounds failure;
  std::vector<StatedHypothesis> hypotheses;  // expected results; runs do not depend on them
  std::optional<Tuning> tuning;              // for `rcme tune`
};

// Returns the parts of an Ademp with their keys, in order.
std::vector<std::pair<std::string, std::string*>> Parts(Ademp& ademp);

// Returns the names of the columns of the design: for a population kDrawFactor and its keys; then the
// factors.
std::vector<std::string> FactorNames(const Study& study);

// Returns the design: a row per condition with a level per factor, the first factor slowest. For a
// population, only draws that meet its restrictions. Throws InputError if there are more than kMaxConditions
// rows, or if a one-at-a-time design lacks a factor's base value in `data`.
std::vector<std::vector<std::string>> DesignRows(const Study& study);
// FactorRows returns the design of the factors alone; JoinLevels joins the levels of a draw and such a row.
std::vector<std::vector<std::string>> FactorRows(const Study& study);
std::vector<std::string> JoinLevels(const PopulationDraw& draw, const std::vector<std::string>& of_factors);

// Returns the settings of a condition: `data`, then its levels except those of estimator options.
Settings CombineSettings(const Study& study, const std::vector<std::string>& levels);

// Returns whether a factor is an option of an estimator, LABEL.OPTION.
bool IsEstimatorOption(const std::string& factor);

// Returns the estimators of a condition: those of the study, with the options that are levels of the
// condition.
std::vector<EstimatorSpec> ResolveEstimators(const Study& study, const std::vector<std::string>& levels);

// Throws InputError if estimator options are factors, because `who` does not support them.
void RequireFixedOptions(const Study& study, const std::string& who);

}  // namespace rcme
