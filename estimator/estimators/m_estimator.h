#pragma once

#include <memory>

#include "estimator/estimator_model.h"

namespace rcme {

// The motion of the best MSAC hypothesis (robust_score.h), not refined, as the start of an M-estimation over
// all matches (refinement/m_estimation.h), which takes the place of the refinement. Options of MSAC but those
// of the refinement; and `loss`, `tuning_constant`.
std::unique_ptr<EstimatorModel> MEstimatorModel();

}  // namespace rcme
