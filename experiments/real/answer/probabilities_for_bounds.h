// What an estimator states beside its answer, from the same fit: failure probabilities for other bounds, and
// the distribution of the motion.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "estimator/calibrated/motion_posterior.h"
#include "estimator/motion_estimator.h"
#include "experiments/study/study.h"

namespace rcme {

struct ProbabilityForBounds {
  FailureBounds bounds;
  double failure_probability = 1.0;
  // The domain of the stated probability for bounds of 1 to 10 deg and 5 to 40 deg, which
  // results/posterior_ranks covers; otherwise extrapolated.
  ProbabilityDomain domain = ProbabilityDomain::kExtrapolated;
};

struct PosteriorRequest {
  std::vector<FailureBounds> bounds = {};  // a failure probability for each
  bool is_kept = false;                    // return the posterior if the estimator has one
};

struct EstimateForBounds {
  MotionEstimate estimate;                          // as Estimate returns it
  std::vector<ProbabilityForBounds> probabilities;  // one for each of the bounds; empty without a motion
  std::optional<MotionPosterior> posterior;  // if requested, the estimator has one, and the status is ok
};

// Answers with the stream of samples for `seed` and checks the answer (trial/answer_check.h). `rcme estimate`
// and Python use this function. Throws InputError if bounds are given but the estimator has no posterior
// (calibrated/motion_posterior.h).
EstimateForBounds AnswerProblem(const MotionEstimator& estimator, const MotionProblem& problem,
                                const PosteriorRequest& request, std::uint64_t seed);

}  // namespace rcme
