// The estimators that AddPeers adds, one file each, with their options.
//
// A threshold is given in standard deviations of what is compared with it, `threshold_sigma`: of the match's
// distance from the motion's epipolar lines in the measure of the library, for noise of sigma in every
// coordinate, to first order. So 2 keeps 95 % of the true matches whatever the library calls a distance.
#pragma once

#include <memory>

#include "estimator/estimator_model.h"

namespace rcme {

std::unique_ptr<EstimatorModel> OpenCvUsacModel();
std::unique_ptr<EstimatorModel> OpenCvRansacModel();
std::unique_ptr<EstimatorModel> OpenCvLmedsModel();
std::unique_ptr<EstimatorModel> OpenGvRansacModel();
std::unique_ptr<EstimatorModel> PoseLibModel();  // only where CMake finds PoseLib

}  // namespace rcme
