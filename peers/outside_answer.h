// The one interface for estimators outside the program: a function of Python, a process, a file of results.
// All give the same answer, and the same is made of it.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"
#include "stats/random.h"

namespace rcme {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

// What an estimator outside the program says. It knows nothing of the tangent basis that pose_cov of a
// MotionEstimate is in: its covariance is of [w, dt], R <- Exp(w) R (rad) and t <- t + dt, in the length of
// the t that it gives.
struct OutsideAnswer {
  MotionStatus status = MotionStatus::kOk;  // any that StatusOfOutside gives
  std::string message;                      // empty: none
  // With status ok. t of any length: the scale cannot be seen.
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  std::optional<Matrix6d> pose_cov;         // nothing: first order, of the inliers
  std::optional<std::vector<int>> inliers;  // nothing: the matches that agree with the motion
  // NaN and empty: not stated. As in MotionEstimate.
  double failure_probability = std::numeric_limits<double>::quiet_NaN();
  double sigma_px = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> inlier_probabilities;
  double seconds = std::numeric_limits<double>::quiet_NaN();
};

// Why there is no answer: timed_out, no_answer, unreadable_answer, or library_error where the estimator
// itself reports an error.
class NoOutsideAnswer : public std::runtime_error {
 public:
  NoOutsideAnswer(MotionStatus status, const std::string& message)
      : std::runtime_error(message), status_(status) {}
  MotionStatus status() const { return status_; }

 private:
  MotionStatus status_;
};

// The status of that name. Throws NoOutsideAnswer (unreadable_answer) for an unknown one, and for those that
// only the judge of answers or of trials gives (invalid_motion, not_simulated, ...).
MotionStatus StatusOfOutside(const std::string& name);

// The covariance of [rotation, direction] (5x5, rad^2) from that of [w, dt]: what dt does along t is no part
// of the direction. And back, for |t| = 1: rank 5, with nothing along t.
Matrix5d TangentCovariance(const Matrix6d& covariance, const Eigen::Vector3d& t);
Matrix6d CovarianceWithTranslation(const Matrix5d& pose_cov, const Eigen::Vector3d& t);

// A number of 31 bits, which every library takes for a seed: the first thing drawn for a call, in all ways.
inline std::uint32_t SeedForOutside(RandomStream& rng) { return rng.Next32() >> 1; }

// The estimate that the answer is; it is not judged yet (a rotation that is none stays one that is none). The
// problem is checked before `ask` is called, as for a peer; what `ask` throws is a status.
MotionEstimate CallOutside(const MotionProblem& problem, const std::function<OutsideAnswer()>& ask);

}  // namespace rcme
