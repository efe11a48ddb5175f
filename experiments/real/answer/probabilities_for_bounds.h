// The probability of failure for bounds other than the estimator's own, from the same fit.
#pragma once

#include <cstdint>
#include <vector>

#include "estimator/motion_estimator.h"
#include "experiments/study/study.h"

namespace rcme {

struct ProbabilityForBounds {
  FailureBounds bounds;
  double failure_probability = 1.0;
  // That of the stated probability for bounds of 1 to 10 deg and 5 to 40 deg, which
  // results/posterior_ranks covers; otherwise extrapolated.
  ProbabilityDomain domain = ProbabilityDomain::kExtrapolated;
};

struct EstimateForBounds {
  MotionEstimate estimate;                          // as Estimate returns it
  std::vector<ProbabilityForBounds> probabilities;  // one for each of the bounds; none without a motion
};

// Throws InputError where there are bounds and the estimator has no posterior
// (calibrated/motion_posterior.h).
EstimateForBounds EstimateWithBounds(const MotionEstimator& estimator, const MotionProblem& problem,
                                     const std::vector<FailureBounds>& bounds, RandomStream& rng);

// The same of the stream of samples that belongs to `seed`, judged (trial/answer_check.h): what `rcme
// estimate` and Python answer to a problem.
EstimateForBounds AnswerProblem(const MotionEstimator& estimator, const MotionProblem& problem,
                                const std::vector<FailureBounds>& bounds, std::uint64_t seed);

}  // namespace rcme
