#pragma once

#include "estimator/motion_estimator.h"
#include "estimator/ransac_options.h"

namespace rcme {

// RCME, and pRCME: the same without the test of the model against its sample.
class RcmeEstimator : public MotionEstimator {
 public:
  enum class SampleTest { kOn, kOff };

  // Throws InputError if the options contradict each other.
  RcmeEstimator(const RansacOptions& options, SampleTest sample_test);
  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override;

 private:
  RansacOptions options_;
  SampleTest sample_test_;
};

}  // namespace rcme
