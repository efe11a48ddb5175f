// Whether an estimator's answer is what its status says. Every answer is judged before it is scored: one that
// is not valid gets a status of its own, which counts as a failure whatever the truth is.
#pragma once

#include <optional>
#include <string>

#include "estimator/motion_estimate.h"

namespace rcme {

// Largest entry of |R'R - I| and largest ||t| - 1| that pass as rounding. A rotation computed in single
// precision (2^-24 = 6e-8 an operation) deviates by some 4e-7; 1e-6 is an angle of 6e-5 degrees, far below
// what noise leaves of any motion. A rotation read from text with four digits does not pass.
inline constexpr double kMaxMotionRounding = 1e-6;

// Largest asymmetry and most negative eigenvalue of a covariance that pass as rounding, both of the matrix
// scaled to unit diagonal (the correlations), so that a rotation known 1,000 times better than the direction
// is held to the same standard. The inverse of an information matrix of condition number 1e9 has 1e-7.
inline constexpr double kMaxCovarianceRounding = 1e-6;

// R finite, R'R = I and det R = +1.
bool IsRotation(const Eigen::Matrix3d& R);
// Finite and of length one.
bool IsUnitVector(const Eigen::Vector3d& t);
// Finite, symmetric and positive semidefinite. Zero passes: it claims to know the motion exactly, which the
// score answers with an infinite NEES.
bool IsCovariance(const Matrix5d& covariance);

struct AnswerFault {
  MotionStatus status = MotionStatus::kInvalidMotion;  // or kInvalidCovariance
  std::string message;                                 // what is wrong, one sentence
};

// What is wrong with the answer to a problem of `num_matches`; nothing: it is valid.
// invalid_motion: an unknown status, inliers that are no matches or are repeated, counts that cannot be, or,
// where the status promises them (ok: both; direction_not_observable: the rotation), R and t that are not a
// valid motion. invalid_covariance: status ok, a valid motion, and an invalid covariance.
std::optional<AnswerFault> FindFault(const MotionEstimate& estimate, size_t num_matches);

// The answer as it is scored: itself if it is valid, else with the fault's status and message, and without
// inliers and counts that cannot be.
MotionEstimate Judged(MotionEstimate estimate, size_t num_matches);

}  // namespace rcme
