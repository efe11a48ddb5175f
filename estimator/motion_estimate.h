#pragma once

#include <limits>
#include <string>
#include <vector>

#include "estimator/geometry/pose.h"
#include "estimator/sample.h"

namespace rcme {

// How a call ended. kOk alone carries a whole motion, kDirectionNotObservable a rotation.
enum class MotionStatus {
  kOk,                  // a motion was found and refined
  kNoCandidate,         // the paper's "Detect-fail": the candidate set is empty
  kTooFewMatches,       // fewer distinct matches than a minimal sample needs
  kDegenerateMatches,   // the matches do not determine a motion (collinear, or every sample is degenerate)
  kRefinementDiverged,  // the refinement found no finite optimum, or at most five matches agree with it
  kTooFewExplained,     // the refined motion explains a smaller share of the matches than required
  kDirectionNotObservable,  // the parallax is within the noise: there is a rotation, but no direction
  kNotBetterThanChance,     // chance explains that many agreeing matches
  kTooUncertain,            // the failure probability is greater than allowed
  // From the gate of model choice (model_choice/gate.h), if it is on.
  kPlanarScene,        // the matches lie on a plane
  kRotationOnly,       // a rotation explains the matches
  kTooLittleParallax,  // too few of the matches show parallax beyond the noise
  kLibraryError,       // a library that the estimator calls threw, or gave no finite motion
  // From estimators outside the program (peers/outside_answer.h).
  kTimedOut,          // no answer within the time limit
  kNoAnswer,          // its process ended without an answer
  kUnreadableAnswer,  // not JSON, a matrix of the wrong shape, or an unknown status
  kInvalidInput,      // NaN or infinite coordinates, a singular camera, a noise level not positive
  // Set in the place of kOk by the check of an answer; estimators do not return these.
  kInvalidMotion,      // not a rotation and a unit vector, or not finite
  kInvalidCovariance,  // not finite, symmetric and positive semidefinite
  // The trial has no answer that could be judged.
  kNotSimulated,  // the simulator cannot make a trial of this condition, drawn from a population
  kTruthInDoubt,  // the ground truth of this real pair is listed as doubtful: answers are not judged
};

// The name of a status in files and programs ("ok", "no_candidate", ...), and all statuses.
const std::string& StatusName(MotionStatus status);
const std::vector<MotionStatus>& AllStatuses();

// Counts of the hypothesis loop, for diagnosis. The last five sum to num_hypotheses.
struct LoopCounts {
  int num_hypotheses = 0;             // models of the drawn samples; a sample without a model counts as one
  int num_degenerate_samples = 0;     // no model from the sample, or no covariance of the model
  int num_inconsistent_samples = 0;   // failed the sample test (eq::sample-p-test)
  int num_poor_inlier_sets = 0;       // failed the inlier quality test (eq::inlier-quality-test)
  int num_too_small_inlier_sets = 0;  // failed the size condition (eq:inlier_size_cond)
  int num_candidates = 0;             // |C| (eq::candidate-set)
};

// The main reason why a motion is uncertain; the estimator's message explains it with numbers.
enum class Doubt {
  kNone,              // the motion is very likely right, or the estimator does not look for doubts
  kOtherMotion,       // another motion explains matches that this one does not
  kPlane,             // the matches lie near a plane: two motions explain them
  kFewMatchesDecide,  // one or a few matches with a large influence decide between motions
  kOppositeWay,       // the direction of translation may have the opposite sign
  kLowParallax,       // hardly any parallax: the direction is poorly determined
  kFewMatches,        // few matches agree with the motion: chance might explain them
  kModel,             // the matches contradict the estimator's model of them
};

// Whether the matches look like those of the problems on which a stated failure probability was fitted and
// verified.
enum class ProbabilityDomain {
  kNotStated,     // the estimator does not say
  kVerified,      // like them
  kExtrapolated,  // in some respect outside of the range of nearly all of them
};
// "not_stated", "verified", "extrapolated".
const char* Name(ProbabilityDomain domain);

// How the prior of the motion (MotionProblem::prior) was used.
enum class PriorUse {
  kNone,          // no prior, or the estimator takes none
  kUsed,          // the answer is from the matches and the prior
  kContradicted,  // the matches contradict it: the answer is from the matches alone
};
// "none", "used", "contradicted".
const char* Name(PriorUse use);

// Another motion that explains the matches, with its evidence.
struct MotionMode {
  RelativePose cam2_from_cam1;
  Matrix5d pose_cov = Matrix5d::Zero();  // 5x5 [rotation, direction], rad^2
  double weight = 0.0;                   // probability that it is the right one
  double explained_share = 0.0;          // share of all matches that it explains and the answer does not
};

struct MotionEstimate {
  MotionStatus status = MotionStatus::kInvalidInput;
  std::string message;  // one sentence for a person

  // Valid if the status is kOk. If it is kDirectionNotObservable, R and the rotation block of the covariance
  // are valid and the rest is NaN.
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

  // Number of all matches that agree with the refined motion: squared Sampson distance within
  // ConsistencyThreshold (motion_tests.h). The motion's covariance is not used, so that a poorly determined
  // motion does not explain more matches.
  int num_explained = 0;

  LoopCounts counts;

  // From estimators that state probabilities; others leave NaN and empty lists.
  double failure_probability = std::numeric_limits<double>::quiet_NaN();  // error beyond the options' bounds
  double sigma_estimated_px = std::numeric_limits<double>::quiet_NaN();   // from the residuals
  double sigma_estimated_sd_px = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> inlier_probabilities;  // one per match
  std::vector<MotionMode> other_modes;       // the most likely first
  Doubt doubt = Doubt::kNone;
  ProbabilityDomain probability_domain = ProbabilityDomain::kNotStated;

  // Probability that the calibration has errors that nobody stated (unstated_errors.h), which pose_cov
  // counts; 0: they are not counted.
  double calibration_error_probability = std::numeric_limits<double>::quiet_NaN();
  // The covariances if it has none and if it has them; pose_cov is their mean, weighed by the probabilities.
  // Zero if calibration_error_probability is NaN.
  Matrix5d pose_cov_without_errors = Matrix5d::Zero(), pose_cov_with_errors = Matrix5d::Zero();

  PriorUse prior = PriorUse::kNone;
  // Probability that a correct prior is at least this far from the motion of the matches alone; NaN: not
  // computed.
  double prior_p_value = std::numeric_limits<double>::quiet_NaN();

  // Time spent in another process or on another machine, s; NaN: none.
  double seconds_elsewhere = std::numeric_limits<double>::quiet_NaN();
};

// pose_cov if the calibration has no errors that nobody stated.
const Matrix5d& CovarianceWithoutErrors(const MotionEstimate& estimate);
// Mixes both covariances into pose_cov.
void MixErrors(MotionEstimate* estimate);

// No motion, and why.
MotionEstimate MakeRefusal(MotionStatus status, std::string message, const LoopCounts& counts = {});

}  // namespace rcme
