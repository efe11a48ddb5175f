#include "estimator/motion_estimate.h"

#include <utility>

namespace rcme {

const std::string& StatusName(MotionStatus status) {
  static const std::vector<std::string> names = {"ok",
                                                 "no_candidate",
                                                 "too_few_matches",
                                                 "degenerate_matches",
                                                 "refinement_diverged",
                                                 "too_few_explained",
                                                 "direction_not_observable",
                                                 "not_better_than_chance",
                                                 "too_uncertain",
                                                 "planar_scene",
                                                 "rotation_only",
                                                 "too_little_parallax",
                                                 "library_error",
                                                 "timed_out",
                                                 "no_answer",
                                                 "unreadable_answer",
                                                 "invalid_input",
                                                 "invalid_motion",
                                                 "invalid_covariance",
                                                 "not_simulated",
                                                 "truth_in_doubt"};
  return names[static_cast<size_t>(status)];
}

const std::vector<MotionStatus>& AllStatuses() {
  static const std::vector<MotionStatus> all = [] {
    std::vector<MotionStatus> statuses;
    for (int i = 0; i <= static_cast<int>(MotionStatus::kTruthInDoubt); ++i)
      statuses.push_back(static_cast<MotionStatus>(i));
    return statuses;
  }();
  return all;
}

const char* Name(ProbabilityDomain domain) {
  switch (domain) {
    case ProbabilityDomain::kNotStated:
      break;
    case ProbabilityDomain::kVerified:
      return "verified";
    case ProbabilityDomain::kExtrapolated:
      return "extrapolated";
  }
  return "not_stated";
}

const char* Name(PriorUse use) {
  switch (use) {
    case PriorUse::kNone:
      break;
    case PriorUse::kUsed:
      return "used";
    case PriorUse::kContradicted:
      return "contradicted";
  }
  return "none";
}

const Matrix5d& CovarianceWithoutErrors(const MotionEstimate& estimate) {
  return estimate.calibration_error_probability > 0.0 ? estimate.pose_cov_without_errors : estimate.pose_cov;
}

void MixErrors(MotionEstimate* estimate) {
  const double weight = estimate->calibration_error_probability;
  estimate->pose_cov =
      (1.0 - weight) * estimate->pose_cov_without_errors + weight * estimate->pose_cov_with_errors;
}

MotionEstimate MakeRefusal(MotionStatus status, std::string message, const LoopCounts& counts) {
  MotionEstimate refusal;
  refusal.status = status;
  refusal.message = std::move(message);
  refusal.counts = counts;
  return refusal;
}

}  // namespace rcme
