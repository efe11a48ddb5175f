// Model choice as a gate for any estimator: it refuses a motion if the kind of problem does not determine one
// well.
#pragma once

#include <memory>

#include "estimator/estimator_model.h"

namespace rcme {

// The same estimator with additional options:
//
//   model_choice       the criterion (verdict.h), or off, the default: Make returns the bare estimator
//   planar_scenes      refused (the default) or answered
//
// and the two of ModelChoiceOptions, parallax_significance_level and least_parallax_share.
//
// The gate decides after the estimator has answered and draws from the same random stream, so an answer that
// passes is identical to the one without the gate. Its refusals (planar_scene, rotation_only,
// too_little_parallax) have no motion. The estimator's own refusals, and answers for which there is no
// verdict, stay unchanged. A model that already has an option model_choice (one made from an estimator of the
// registry) is returned unchanged.
std::unique_ptr<EstimatorModel> WithGate(std::unique_ptr<EstimatorModel> model);

}  // namespace rcme
