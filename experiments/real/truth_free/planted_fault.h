// Puts known faults into pairs or an estimator, to check whether a validation of these pairs detects them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "estimator/motion_estimator.h"
#include "experiments/real/truth_free/camera_faults.h"
#include "experiments/real/truth_free/pair_set.h"

namespace rcme {

struct PlantedFaults {
  double covariance = 1.0;  // factor on the estimator's covariances
  double sigma = 1.0;       // factor on the assumed sigma
  FaultVector camera = FaultVector::Zero();
};

// `settings`: NAME=VALUE each. Throws InputError that lists the allowed names.
PlantedFaults ParsePlantedFaults(const std::vector<std::string>& settings);
std::string PlantableFaults();  // "covariance, sigma, focal_length, ..."

PairSet PlantFaultsIn(PairSet set, const PlantedFaults& faults);

// Wraps an estimator so that its covariances are multiplied by `factor`.
std::unique_ptr<MotionEstimator> ScaleCovariances(std::unique_ptr<MotionEstimator> estimator, double factor);

}  // namespace rcme
