// The estimators that AddPeers adds, one file each, with their options.
//
// `threshold_sigma` gives a threshold in standard deviations of the quantity that the library compares with
// it: the library's measure of a match's distance from the epipolar lines, for noise of sigma in every
// coordinate, to first order. A value of 2 thus keeps 95 % of the true matches for every library.
#pragma once

#include <memory>

#include "estimator/estimator_model.h"

namespace rcme {

std::unique_ptr<EstimatorModel> OpenCvUsacModel();
std::unique_ptr<EstimatorModel> OpenCvRansacModel();
std::unique_ptr<EstimatorModel> OpenCvLmedsModel();
std::unique_ptr<EstimatorModel> OpenGvRansacModel();
std::unique_ptr<EstimatorModel> PoseLibModel();         // only where CMake finds PoseLib
std::unique_ptr<EstimatorModel> PoseLibGravityModel();  // only where it finds PoseLib 3

}  // namespace rcme
