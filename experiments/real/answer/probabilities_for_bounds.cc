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
                                     const std::vector<FailureBounds>& bounds, RandomStream& rng) {
  if (bounds.empty()) return {estimator.Estimate(problem, rng), {}};
  const WeightInspection* inspection = FindWeightInspection(estimator);
  if (inspection == nullptr)
    throw InputError("bounds: only rcme_calibrated knows the probability of failure for other bounds");
  std::optional<MotionPosterior> posterior;
  EstimateForBounds answer{inspection->EstimateWithPosterior(problem, rng, &posterior), {}};
  if (!posterior || answer.estimate.status != MotionStatus::kOk) return answer;
  const PosteriorDistances distances(*posterior, answer.estimate.cam2_from_cam1);
  for (const FailureBounds& each : bounds) {
    const double p = distances.FailureProbability(
        {kRadPerDeg * each.max_rotation_error_deg, kRadPerDeg * each.max_direction_error_deg});
    answer.probabilities.push_back(
        {each, p, AreCovered(each) ? answer.estimate.probability_domain : ProbabilityDomain::kExtrapolated});
  }
  return answer;
}

}  // namespace

EstimateForBounds AnswerProblem(const MotionEstimator& estimator, const MotionProblem& problem,
                                const std::vector<FailureBounds>& bounds, std::uint64_t seed) {
  RandomStream rng = StreamFor({seed, 0, 0, 0}, StreamPurpose::kSampling);
  EstimateForBounds found = EstimateWithBounds(estimator, problem, bounds, rng);
  found.estimate = Judged(std::move(found.estimate), problem.matches.size());
  return found;
}

}  // namespace rcme
