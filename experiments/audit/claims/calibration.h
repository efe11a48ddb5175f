// The claims about calibration, which make sense for cases from anywhere: one function per family, each claim
// without its cases.
#pragma once

#include "experiments/audit/claims/case_claim.h"
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

// That no more of its motions are beyond the bounds than its answers say, and that the probabilities of
// failure are right where it states them.
CaseClaim FailureCalibration(const std::string& label, const std::string& reading,
                             std::shared_ptr<const MotionEstimator> estimator, const FailureBounds& bounds);

// That the noise level is right where it states one.
CaseClaim SigmaCalibration(const std::string& label, const std::string& reading,
                           std::shared_ptr<const MotionEstimator> estimator);

// All of them. What an estimator states its answers say, never its name or its options.
std::vector<CaseClaim> AnswerCalibration(const std::string& label, const std::string& reading,
                                         std::shared_ptr<const MotionEstimator> estimator,
                                         const FailureBounds& bounds);

}  // namespace rcme
