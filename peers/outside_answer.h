// The common interface of estimators outside the program: a Python function, a process, a file of results.
// All give the same kind of answer, which is converted to an estimate in one way.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"
#include "stats/random.h"

namespace rcme {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

// The answer of an estimator outside the program. Such an estimator does not know the tangent basis of
// MotionEstimate::pose_cov. Its covariance is therefore of [w, dt]: R <- Exp(w) R (rad), and t <- t + dt in
// units of the t that it gives.
struct OutsideAnswer {
  MotionStatus status = MotionStatus::kOk;  // any that StatusOfOutside returns
  std::string message;                      // may be empty
  // Used with status ok. t may have any length, as the scale is not observable.
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  std::optional<Matrix6d> pose_cov;         // nullopt: computed to first order from the inliers
  std::optional<std::vector<int>> inliers;  // nullopt: the matches that agree with the motion
  // As in MotionEstimate; NaN and empty mean not stated.
  double failure_probability = std::numeric_limits<double>::quiet_NaN();
  double sigma_px = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> inlier_probabilities;
  double seconds = std::numeric_limits<double>::quiet_NaN();
};

// How the message of a motion ends whose answer states no covariance.
inline constexpr std::string_view kCovarianceOfRcme = "covariance computed by rcme from its inliers";

// The reason why there is no answer: timed_out, no_answer, unreadable_answer, or library_error if the
// estimator itself reports an error.
class NoOutsideAnswer : public std::runtime_error {
 public:
  NoOutsideAnswer(MotionStatus status, const std::string& message)
      : std::runtime_error(message), status_(status) {}
  MotionStatus status() const { return status_; }

 private:
  MotionStatus status_;
};

// The status of this name. Throws NoOutsideAnswer (unreadable_answer) for an unknown name, and for statuses
// that only the check of answers or trials sets (invalid_motion, not_simulated, ...).
MotionStatus StatusOfOutside(const std::string& name);

// The covariance of [rotation, direction] (5x5, rad^2) from that of [w, dt]; the component of dt along t has
// no effect on the direction. And back, for |t| = 1: rank 5, zero along t.
Matrix5d TangentCovariance(const Matrix6d& covariance, const Eigen::Vector3d& t);
Matrix6d CovarianceWithTranslation(const Matrix5d& pose_cov, const Eigen::Vector3d& t);

// A seed of 31 bits, which every library accepts. It is the first number drawn in a call for every kind of
// estimator.
inline std::uint32_t SeedForOutside(RandomStream& rng) { return rng.Next32() >> 1; }

// Converts the answer of `ask` to an estimate without checking it (an invalid rotation stays invalid). As for
// a peer, the problem is checked before `ask` is called; a NoOutsideAnswer from `ask` becomes a status.
MotionEstimate CallOutside(const MotionProblem& problem, const std::function<OutsideAnswer()>& ask);

}  // namespace rcme
