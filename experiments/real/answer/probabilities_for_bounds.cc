#include "experiments/real/answer/probabilities_for_bounds.h"

#include <optional>
#include <utility>

#include "estimator/estimators/rcme_calibrated.h"
#include "experiments/data/data_source.h"
#include "experiments/trial/answer_check.h"
#include "parameters/input_error.h"
#include "stats/constants.h"

namespace rcme {
namespace {

bool AreCovered(const FailureBounds& bounds) {
  return bounds.max_rotation_error_deg >= 1.0 && bounds.max_rotation_error_deg <= 10.0 &&
         bounds.max_direction_error_deg >= 5.0 && bounds.max_direction_error_deg <= 40.0;
}

EstimateForBounds EstimateWithBounds(const MotionEstimator& estimator, const MotionProblem& problem,
                                     const PosteriorRequest& request, RandomStream& rng) {
  const WeightInspection* inspection = FindWeightInspection(estimator);
  if (!request.bounds.empty() && inspection == nullptr)
    throw InputError(
        "bounds: only rcme_calibrated, without model_choice or conform, knows the probability of failure for other bounds");
  if (inspection == nullptr || (request.bounds.empty() && !request.is_kept))
    return {estimator.Estimate(problem, rng), {}, {}};
  std::optional<MotionPosterior> posterior;
  EstimateForBounds answer{inspection->EstimateWithPosterior(problem, rng, &posterior), {}, {}};
  if (!posterior || answer.estimate.status != MotionStatus::kOk) return answer;
  if (request.is_kept) answer.posterior = posterior;
  if (request.bounds.empty()) return answer;
  const PosteriorDistances distances(*posterior, answer.estimate.cam2_from_cam1);
  for (const FailureBounds& each : request.bounds) {
    const double p = distances.FailureProbability(
        {kRadPerDeg * each.max_rotation_error_deg, kRadPerDeg * each.max_direction_error_deg});
    answer.probabilities.push_back(
        {each, p, AreCovered(each) ? answer.estimate.probability_domain : ProbabilityDomain::kExtrapolated});
  }
  return answer;
}

}  // namespace

EstimateForBounds AnswerProblem(const MotionEstimator& estimator, const MotionProblem& problem,
                                const PosteriorRequest& request, std::uint64_t seed) {
  RandomStream rng = StreamFor({seed, 0, 0, 0}, StreamPurpose::kSampling);
  EstimateForBounds found = EstimateWithBounds(estimator, problem, request, rng);
  found.estimate = Judged(std::move(found.estimate), problem.matches.size());
  return found;
}

}  // namespace rcme
