#pragma once

#include <memory>

#include "estimator/estimator_model.h"

namespace rcme {

// `standard` whose so-far-best hypotheses are optimised inside the loop (local_optimisation.h), and whose
// winner is refined as everybody's. Options of `standard` but the implementation, since there is one, that of
// the reference, and the refinement, which is robust; and
//
//   inner_samples, inner_refits, inner_first_threshold   InnerRansac
std::unique_ptr<EstimatorModel> LoRansacModel();

//   progressive_refits                                   of OptimiseByUncertainty
std::unique_ptr<EstimatorModel> CovRansacModel();

}  // namespace rcme
