// The claims about calibration, one function per family. They make sense for cases from any source, so that
// these claims have no cases yet.
#pragma once

#include "experiments/audit/claims/case.h"
#include "experiments/trial/trial.h"

namespace rcme {

std::vector<CaseClaim> SigmaFCalibration();  // coverage of f, for every solver that finds general motions
std::vector<CaseClaim> SigmaPCalibration();  // coverage of the motion from eight points
// coverage of a point, for the known motion, a fresh and an own point
std::vector<CaseClaim> InlierCalibration();
std::vector<CaseClaim> SampleTestCalibration();  // size of the sample test
std::vector<CaseClaim> EntropyCalibration();     // the entropy's unit
std::vector<CaseClaim> MleCalibration();         // coverage of maximum likelihood
// Coverage of the covariance that an estimator reports. `reading` names the estimator and its options.
CaseClaim EstimatorCalibration(const std::string& label, const std::string& reading,
                               std::shared_ptr<const MotionEstimator> estimator, const FailureBounds& bounds);

// Claims that the estimator's motions do not exceed the bounds more often than its answers say, and that its
// stated probabilities of failure, if any, are right.
CaseClaim FailureCalibration(const std::string& label, const std::string& reading,
                             std::shared_ptr<const MotionEstimator> estimator, const FailureBounds& bounds);

// Claims that the stated noise level, if any, is right.
CaseClaim SigmaCalibration(const std::string& label, const std::string& reading,
                           std::shared_ptr<const MotionEstimator> estimator);

// All three. What an estimator states is taken from its answers, never from its name or options.
std::vector<CaseClaim> AnswerCalibration(const std::string& label, const std::string& reading,
                                         std::shared_ptr<const MotionEstimator> estimator,
                                         const FailureBounds& bounds);

}  // namespace rcme
