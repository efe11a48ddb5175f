#pragma once

#include <memory>

#include "estimator/estimator_model.h"

namespace rcme {

// `standard` with local optimisation of each new best hypothesis inside the loop (local_optimisation.h).
// Options: those of `standard` except the implementation (always the reference) and the refinement (always
// robust); and
//
//   inner_samples, inner_refits, inner_first_threshold   InnerRansac
std::unique_ptr<EstimatorModel> LoRansacModel();

//   progressive_refits                                   num_refits of OptimiseByUncertainty
std::unique_ptr<EstimatorModel> CovRansacModel();

}  // namespace rcme
