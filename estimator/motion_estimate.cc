#include "estimator/motion_estimate.h"

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
  static const std::vector<MotionStatus> all = {MotionStatus::kOk,
                                                MotionStatus::kNoCandidate,
                                                MotionStatus::kTooFewMatches,
                                                MotionStatus::kDegenerateMatches,
                                                MotionStatus::kRefinementDiverged,
                                                MotionStatus::kTooFewExplained,
                                                MotionStatus::kDirectionNotObservable,
                                                MotionStatus::kNotBetterThanChance,
                                                MotionStatus::kTooUncertain,
                                                MotionStatus::kPlanarScene,
                                                MotionStatus::kRotationOnly,
                                                MotionStatus::kTooLittleParallax,
                                                MotionStatus::kLibraryError,
                                                MotionStatus::kTimedOut,
                                                MotionStatus::kNoAnswer,
                                                MotionStatus::kUnreadableAnswer,
                                                MotionStatus::kInvalidInput,
                                                MotionStatus::kInvalidMotion,
                                                MotionStatus::kInvalidCovariance,
                                                MotionStatus::kNotSimulated,
                                                MotionStatus::kTruthInDoubt};
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

}  // namespace rcme
