#pragma once

#include <memory>

#include "estimator/estimator_model.h"

namespace rcme {

// RANSAC whose winner predicts all matches best: motions are uncertain, none is tested, and the greatest
// predictive likelihood decides.
std::unique_ptr<EstimatorModel> PredictiveRansacModel();

}  // namespace rcme
