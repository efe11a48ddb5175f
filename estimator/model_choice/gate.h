// Model choice as a gate before which any estimator can be put: a motion is refused where the problem is of a
// kind that determines none well.
#pragma once

#include <memory>

#include "estimator/estimator_model.h"

namespace rcme {

// The same estimator with the options of the gate beside its own:
//
//   model_choice       the criterion (verdict.h), or off, the default: Make gives what the model itself makes
//   planar_scenes      refused (the default) or answered
//
// and the two of ModelChoiceOptions, parallax_significance_level and least_parallax_share.
//
// The gate looks after the estimator has answered, with what its random stream gives next: what is not
// refused is the answer without the gate, number for number. A refusal (planar_scene, rotation_only,
// too_little_parallax) has no motion. What the estimator refuses stays as it is, and so does its answer where
// there is no verdict. A model that has an option model_choice of its own (one made of an estimator of the
// registry) stays as it is.
std::unique_ptr<EstimatorModel> WithGate(std::unique_ptr<EstimatorModel> model);

}  // namespace rcme
