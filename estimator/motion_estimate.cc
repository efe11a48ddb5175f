#include "estimator/motion_estimate.h"

namespace rcme {

const std::string& StatusName(MotionStatus status) {
  static const std::vector<std::string> names = {"ok",
                                                 "no_candidate",
                                                 "too_few_matches",
                                                 "degenerate_matches",
                                                 "refinement_diverged",
                                                 "too_few_explained",
                                                 "invalid_input"};
  return names[static_cast<size_t>(status)];
}

const std::vector<MotionStatus>& AllStatuses() {
  static const std::vector<MotionStatus> all = {MotionStatus::kOk,
                                                MotionStatus::kNoCandidate,
                                                MotionStatus::kTooFewMatches,
                                                MotionStatus::kDegenerateMatches,
                                                MotionStatus::kRefinementDiverged,
                                                MotionStatus::kTooFewExplained,
                                                MotionStatus::kInvalidInput};
  return all;
}

}  // namespace rcme
