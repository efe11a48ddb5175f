// Faults put into pairs or into an estimator on purpose: would these pairs show them?
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "estimator/motion_estimator.h"
#include "experiments/real/truth_free/camera_faults.h"
#include "experiments/real/truth_free/pair_set.h"

namespace rcme {

struct PlantedFaults {
  double covariance = 1.0;  // the estimator's, times this
  double sigma = 1.0;       // what is assumed, times this
  FaultVector camera = FaultVector::Zero();
};

// Of NAME=VALUE each. Throws InputError that lists the names.
PlantedFaults ParsePlantedFaults(const std::vector<std::string>& settings);
std::string PlantableFaults();  // "covariance, sigma, focal_length, ..."

PairSet PlantFaultsIn(PairSet set, const PlantedFaults& faults);

// The estimator with its covariances times a factor.
std::unique_ptr<MotionEstimator> ScaleCovariances(std::unique_ptr<MotionEstimator> estimator, double factor);

}  // namespace rcme
