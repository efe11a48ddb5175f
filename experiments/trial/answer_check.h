// Checks that an estimator's answer agrees with its status. Every answer is checked before it is scored. An
// invalid answer gets a status of its own, which counts as a failure whatever the truth is.
#pragma once

#include <optional>
#include <string>

#include "estimator/motion_estimate.h"

namespace rcme {

// The largest entry of |R'R - I| and the largest ||t| - 1| accepted as rounding. A rotation computed in
// single precision (2^-24 = 6e-8 per operation) deviates by some 4e-7. 1e-6 is an angle of 6e-5 degrees, far
// below the effect of noise on any motion. A rotation read from text with four digits is not accepted.
inline constexpr double kMaxMotionRounding = 1e-6;

// The largest asymmetry and the most negative eigenvalue of a covariance accepted as rounding. Both are
// those of the matrix scaled to unit diagonal (the correlations), so a rotation known 1,000 times better
// than the direction is checked equally strictly. The inverse of an information matrix with condition number
// 1e9 has 1e-7.
inline constexpr double kMaxCovarianceRounding = 1e-6;

// Returns whether R is finite, R'R = I and det R = +1.
bool IsRotation(const Eigen::Matrix3d& R);
// Returns whether t is finite and has length one.
bool IsUnitVector(const Eigen::Vector3d& t);
// Returns whether the covariance is finite, symmetric and positive semidefinite. A zero matrix passes: it
// states that the motion is known exactly, and any error then gives an infinite NEES.
bool IsCovariance(const Matrix5d& covariance);

struct AnswerFault {
  MotionStatus status = MotionStatus::kInvalidMotion;  // kInvalidMotion or kInvalidCovariance
  std::string message;                                 // what is wrong, in one sentence
};

// Returns whether the answer's estimator, one outside the program, stated no covariance, so that `rcme`
// computed it from the inliers.
bool HasCovarianceOfRcme(const MotionEstimate& estimate);

// Returns what is wrong with the answer to a problem of `num_matches`; nothing if it is valid.
// - invalid_motion: an unknown status; inliers that are repeated or no indices of matches; impossible counts
//   or probabilities; R and t that are not a valid motion although the status promises them (ok: both;
//   direction_not_observable: the rotation).
// - invalid_covariance: status ok, a valid motion, and an invalid covariance.
std::optional<AnswerFault> FindFault(const MotionEstimate& estimate, size_t num_matches);

// Returns the answer to be scored: a valid answer unchanged, an invalid one with the fault's status and
// message. Impossible inliers, counts or probabilities are removed.
MotionEstimate Judged(MotionEstimate estimate, size_t num_matches);

}  // namespace rcme
