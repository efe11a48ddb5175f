#include "peers/outside_answer.h"

#include <fmt/format.h>

#include <algorithm>

#include "estimator/problem_check.h"
#include "parameters/plain_text.h"
#include "peers/peer_call.h"
#include "stats/constants.h"

namespace rcme {
namespace {

constexpr int kMinMatches = 5;  // least number that determines a motion

bool IsOfTheJudge(MotionStatus status) {
  return status == MotionStatus::kInvalidMotion || status == MotionStatus::kInvalidCovariance ||
         status == MotionStatus::kNotSimulated || status == MotionStatus::kTruthInDoubt;
}

// Whether these are valid indices of matches, each at most once.
bool AreInliers(std::vector<int> inliers, size_t num_matches) {
  std::ranges::sort(inliers);
  return std::ranges::adjacent_find(inliers) == inliers.end() &&
         (inliers.empty() || (inliers.front() >= 0 && static_cast<size_t>(inliers.back()) < num_matches));
}

// The given motion, with missing parts computed. Invalid parts stay invalid, for the later check of the
// answer.
MotionEstimate MotionFrom(const MotionProblem& problem, const OutsideAnswer& answer) {
  MotionEstimate estimate;
  estimate.status = MotionStatus::kOk;
  const double length = answer.t.norm();
  estimate.cam2_from_cam1 = {answer.R, length > 0.0 ? Eigen::Vector3d(answer.t / length) : answer.t};
  const RelativePose& pose = estimate.cam2_from_cam1;
  estimate.initial_pose = pose;
  estimate.inlier_probabilities = answer.inlier_probabilities;
  estimate.failure_probability = answer.failure_probability;
  estimate.sigma_estimated_px = answer.sigma_px;
  if (answer.inliers) {
    estimate.inliers = *answer.inliers;
    std::ranges::sort(estimate.inliers);
  }
  if (!pose.R.allFinite() || !pose.t.allFinite() || length == 0.0) return estimate;
  const std::vector<int> agreeing = MatchesThatAgree(problem, pose);
  estimate.num_explained = static_cast<int>(agreeing.size());
  if (!answer.inliers) estimate.inliers = agreeing;
  if (answer.pose_cov) {
    estimate.pose_cov = TangentCovariance(*answer.pose_cov, answer.t);
  } else if (AreInliers(estimate.inliers, problem.matches.size())) {
    // NaN if the inliers do not determine a motion: without a covariance the answer is not valid.
    estimate.pose_cov =
        CovarianceOfInliers(problem, pose, estimate.inliers).value_or(Matrix5d::Constant(kNaN));
  }
  return estimate;
}

// The answer's message. For a motion without a covariance it ends in kCovarianceOfRcme.
std::string MakeMessage(const OutsideAnswer& answer) {
  const std::string own = answer.message.empty() ? "the estimator gave no message" : answer.message;
  if (answer.status != MotionStatus::kOk || answer.pose_cov) return own;
  return (answer.message.empty() ? "" : own + "; ") + std::string(kCovarianceOfRcme);
}

// A refusal; with direction_not_observable it keeps the rotation and its covariance if given.
MotionEstimate RefusalFrom(const OutsideAnswer& answer) {
  MotionEstimate estimate = MakeRefusal(answer.status, answer.message);
  estimate.failure_probability = answer.failure_probability;
  if (answer.status != MotionStatus::kDirectionNotObservable) return estimate;
  estimate.cam2_from_cam1.R = answer.R;
  estimate.cam2_from_cam1.t.setConstant(std::numeric_limits<double>::quiet_NaN());
  estimate.pose_cov.setConstant(std::numeric_limits<double>::quiet_NaN());
  if (answer.pose_cov) estimate.pose_cov.topLeftCorner<3, 3>() = answer.pose_cov->topLeftCorner<3, 3>();
  return estimate;
}

}  // namespace

MotionStatus StatusOfOutside(const std::string& name) {
  std::string allowed;
  for (const MotionStatus status : AllStatuses()) {
    if (IsOfTheJudge(status)) continue;
    if (StatusName(status) == name) return status;
    allowed += (allowed.empty() ? "" : ", ") + StatusName(status);
  }
  throw NoOutsideAnswer(MotionStatus::kUnreadableAnswer,
                        fmt::format("status {} is not known; allowed: {}", Quoted(name), allowed));
}

Matrix5d TangentCovariance(const Matrix6d& covariance, const Eigen::Vector3d& t) {
  // d direction = B' dt / |t| to first order.
  Eigen::Matrix<double, 5, 6> J = Eigen::Matrix<double, 5, 6>::Zero();
  J.topLeftCorner<3, 3>().setIdentity();
  J.bottomRightCorner<2, 3>() = DirectionBasis(t.normalized()).transpose() / t.norm();
  return J * covariance * J.transpose();
}

Matrix6d CovarianceWithTranslation(const Matrix5d& pose_cov, const Eigen::Vector3d& t) {
  Eigen::Matrix<double, 6, 5> J = Eigen::Matrix<double, 6, 5>::Zero();
  J.topLeftCorner<3, 3>().setIdentity();
  J.bottomRightCorner<3, 2>() = DirectionBasis(t);
  return J * pose_cov * J.transpose();
}

MotionEstimate CallOutside(const MotionProblem& problem, const std::function<OutsideAnswer()>& ask) {
  if (std::optional<MotionEstimate> refusal = RefuseUnsolvable(problem, kMinMatches)) return *refusal;
  try {
    const OutsideAnswer answer = ask();
    MotionEstimate estimate =
        answer.status == MotionStatus::kOk ? MotionFrom(problem, answer) : RefusalFrom(answer);
    estimate.message = Printable(MakeMessage(answer), 1000);
    estimate.seconds_elsewhere = answer.seconds;
    return estimate;
  } catch (const NoOutsideAnswer& none) {
    return MakeRefusal(none.status(), Printable(none.what(), 1000));
  }
}

}  // namespace rcme
