// The block `tune` of a study file:
//
//   tune:
//     estimator: rcme_rank_aware            # a label of the study
//     target: failure                       # Parameters(Tuning&) lists the keys except `options`
//     at_most: 0.05
//     explore: 100
//     options:
//       mu: {from: 0, to: 12, step: 0.5}    # 0, 0.5, ..., 12
//       selection: [mean_entropy, predictive_likelihood]
#pragma once

#include "experiments/core/files/yaml_input.h"
#include "experiments/study/study.h"

namespace rcme {

// Reads and validates the block for a study with these estimators. The estimator must accept every level of
// every option and every combination of levels.
Tuning ReadTuning(const Place& place, const YAML::Node& node, const std::vector<EstimatorSpec>& estimators);

// Returns the estimator to be tuned. Throws InputError that lists the labels.
const EstimatorSpec& TunedEstimator(const Tuning& tuning, const std::vector<EstimatorSpec>& estimators);

// Throws InputError that names the first combination whose options contradict each other.
void CheckCombinations(const Tuning& tuning, const std::vector<EstimatorSpec>& estimators);

}  // namespace rcme
