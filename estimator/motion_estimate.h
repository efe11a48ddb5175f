#pragma once

#include <limits>
#include <string>
#include <vector>

#include "estimator/geometry/pose.h"
#include "estimator/sample.h"

namespace rcme {

// How a call ended, or why there was none. Every call ends in one of these; only kOk carries a motion,
// kDirectionNotObservable a rotation.
enum class MotionStatus {
  kOk,                      // a motion was found and refined
  kNoCandidate,             // the paper's "Detect-fail": the candidate set is empty
  kTooFewMatches,           // fewer distinct matches than a minimal sample needs
  kDegenerateMatches,       // the matches cannot determine a motion (collinear, or every sample is singular)
  kRefinementDiverged,      // the refinement found no finite optimum, or at most five matches agree with it
  kTooFewExplained,         // the refined motion explains a smaller share of the matches than was asked for
  kDirectionNotObservable,  // the parallax is within its noise: the rotation is given, the direction is not
  kNotBetterThanChance,     // no more matches agree with the motion than would agree with any motion
  kTooUncertain,            // the probability that the motion is wrong is greater than what was allowed
  // What kind of problem it is, where the estimator is asked to look at that (model_choice/gate.h).
  kPlanarScene,        // the matches lie on a plane
  kRotationOnly,       // no translation to be seen
  kTooLittleParallax,  // too few of the matches show parallax beyond the noise
  kLibraryError,       // another library that the estimator calls failed: an exception, or no finite motion
  // Of estimators outside the program (peers/outside_answer.h).
  kTimedOut,          // no answer within the time that was allowed
  kNoAnswer,          // none at all: its process ended
  kUnreadableAnswer,  // something that is no answer: no JSON, a matrix of another shape, an unknown status
  kInvalidInput,      // NaN or infinite coordinates, a singular camera, a noise level not positive
  // Never an estimator's own: what the check of its answer makes of kOk.
  kInvalidMotion,      // not a rotation and a unit vector, or not finite
  kInvalidCovariance,  // not finite, symmetric and positive semidefinite
  // Nobody's answer: there was nothing to ask, or nothing to judge it by.
  kNotSimulated,  // the simulator could not make this trial of a condition that was drawn from a population
  kTruthInDoubt,  // a pair whose given truth is listed as in doubt: no answer to it is judged
};

// The status as a word for files and programs ("ok", "no_candidate", ...), and back.
const std::string& StatusName(MotionStatus status);
const std::vector<MotionStatus>& AllStatuses();

// What the hypothesis loop saw, for diagnosis; counts sum to num_hypotheses.
struct LoopCounts {
  int num_hypotheses = 0;             // models of the drawn samples; a sample without a model counts as one
  int num_degenerate_samples = 0;     // no model from the sample, or no covariance of the model
  int num_inconsistent_samples = 0;   // failed the sample test (eq::sample-p-test)
  int num_poor_inlier_sets = 0;       // failed the inlier quality test (eq::inlier-quality-test)
  int num_too_small_inlier_sets = 0;  // failed the size condition (eq:inlier_size_cond)
  int num_candidates = 0;             // |C| (eq::candidate-set)
};

// What makes a motion uncertain first of all; the estimator's message says it in words, with numbers.
enum class Doubt {
  kNone,              // nothing: the motion is very likely right, or the estimator does not ask
  kOtherMotion,       // another motion explains matches that this one does not
  kPlane,             // the matches lie near a plane: two motions explain them
  kFewMatchesDecide,  // one or a few matches with a large influence decide between motions
  kOppositeWay,       // the direction of translation may have the opposite sign
  kLowParallax,       // hardly any parallax: the direction is poorly determined
  kFewMatches,        // few matches agree with the motion, chance might give as many
  kModel,             // the matches are not as the estimator's model has them
};

// Whether a stated probability of failure is of problems like those that it was fitted and verified on, as
// far as the matches show that.
enum class ProbabilityDomain {
  kNotStated,     // the estimator does not say
  kVerified,      // like them
  kExtrapolated,  // unlike nearly all of them in some respect
};
// "not_stated", "verified", "extrapolated".
const char* Name(ProbabilityDomain domain);

// Another motion that explains the matches, with what speaks for it.
struct MotionMode {
  RelativePose cam2_from_cam1;
  Matrix5d pose_cov = Matrix5d::Zero();  // 5x5 [rotation, direction], rad^2
  double weight = 0.0;                   // probability that it is the right one
  double explained_share = 0.0;          // of all matches: those it explains and the answer does not
};

struct MotionEstimate {
  MotionStatus status = MotionStatus::kInvalidInput;
  std::string message;  // one sentence for a person

  // Valid if status is kOk. If it is kDirectionNotObservable, R and the covariance's rotation block are, and
  // the rest is NaN.
  RelativePose cam2_from_cam1;
  Matrix5d pose_cov = Matrix5d::Zero();  // 5x5 [rotation, direction], rad^2
  std::vector<int> inliers;              // indices of the matches consistent with the motion, ascending

  // The selected hypothesis j, before refinement. Estimators without samples leave the sample empty.
  HypothesisId hypothesis;
  RelativePose initial_pose;
  int num_support = 0;        // n_j
  double mean_entropy = 0.0;  // psi_j
  double z_statistic = 0.0;   // Z_j

  // The paper's own failure flag (eq::metric): consistent matches before and after the refinement.
  int num_consistent_before = 0;  // n_I
  int num_consistent_after = 0;   // n*_I
  bool failed_by_kappa = false;   // n*_I / n_I <= kappa

  // Matches, of all, that agree with the refined motion: squared Sampson distance within
  // ConsistencyThreshold (motion_tests.h). The motion's covariance is not used, so that a poorly
  // determined motion does not explain more matches.
  int num_explained = 0;

  LoopCounts counts;

  // Of estimators that give probabilities; the others leave NaN and empty lists.
  double failure_probability = std::numeric_limits<double>::quiet_NaN();  // beyond the bounds of its options
  double sigma_estimated_px = std::numeric_limits<double>::quiet_NaN();   // from the residuals
  double sigma_estimated_sd_px = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> inlier_probabilities;  // one per match
  std::vector<MotionMode> other_modes;       // the most likely first
  Doubt doubt = Doubt::kNone;
  ProbabilityDomain probability_domain = ProbabilityDomain::kNotStated;

  // Time of the part of the call that ran in another process or on another machine, s; NaN: none did.
  double seconds_elsewhere = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace rcme
