// The claims about calibration, which make sense for cases from anywhere: one function per family, each claim
// without its cases.
#pragma once

#include "experiments/claims/case_claim.h"
#include "experiments/trial/trial.h"

namespace rcme {

std::vector<CaseClaim> SigmaFCalibration();      // coverage of f, for every solver of any motion
std::vector<CaseClaim> SigmaPCalibration();      // of the motion of eight points
std::vector<CaseClaim> InlierCalibration();      // of a point: the known motion, a fresh point, an own point
std::vector<CaseClaim> SampleTestCalibration();  // size of the sample test
std::vector<CaseClaim> EntropyCalibration();     // the entropy's unit
std::vector<CaseClaim> MleCalibration();         // coverage of maximum likelihood
// Coverage of the covariance that an estimator reports. `reading` says which estimator with which options.
CaseClaim EstimatorCalibration(const std::string& label, const std::string& reading,
                               std::shared_ptr<const MotionEstimator> estimator, const FailureBounds& bounds);

// That its stated probabilities of failure are right. Only of an estimator that states them
// (StatesProbability).
CaseClaim ProbabilityCalibration(const std::string& label, const std::string& reading,
                                 std::shared_ptr<const MotionEstimator> estimator,
                                 const FailureBounds& bounds);
// Who states a probability can refuse by it: an estimator with the option max_failure_probability.
bool StatesProbability(const std::string& estimator);

}  // namespace rcme
