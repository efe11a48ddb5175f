#pragma once

#include <memory>

#include "estimator/estimator_model.h"

namespace rcme {

// M-estimation over all matches (refinement/m_estimation.h), starting at the unrefined motion of the best
// MSAC hypothesis (robust_score.h). Options: those of MSAC except the ones of the refinement; and `loss`,
// `tuning_constant`.
std::unique_ptr<EstimatorModel> MEstimatorModel();

}  // namespace rcme
