#include "peers/peer_call.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>

#include "estimator/geometry/essential_matrix.h"
#include "estimator/geometry/sampson.h"
#include "estimator/motion_tests.h"
#include "estimator/problem_check.h"
#include "estimator/refine_winner.h"
#include "estimator/uncertainty/motion_covariance.h"

namespace rcme {
namespace {

// The default of the RANSAC family.
constexpr double kSignificanceLevel = 0.05;

MotionEstimate EstimateFrom(const MotionProblem& problem, const std::string& library, PeerAnswer answer) {
  const RelativePose& pose = answer.cam2_from_cam1;
  if (!pose.R.allFinite() || !(std::abs(pose.t.norm() - 1.0) < 1e-6))
    return MakeRefusal(MotionStatus::kLibraryError,
                       library + ": its motion is not finite, or has no direction");
  std::ranges::sort(answer.inliers);
  const std::optional<Matrix5d> pose_cov = CovarianceOfInliers(problem, pose, answer.inliers);
  if (!pose_cov) {
    return MakeRefusal(
        MotionStatus::kDegenerateMatches,
        fmt::format("the {} inliers of {} do not determine a motion", answer.inliers.size(), library));
  }
  MotionEstimate estimate;
  estimate.status = MotionStatus::kOk;
  estimate.message =
      SuccessMessage(static_cast<int>(answer.inliers.size()), static_cast<int>(problem.matches.size()));
  estimate.cam2_from_cam1 = estimate.initial_pose = pose;
  estimate.pose_cov = *pose_cov;
  estimate.inliers = std::move(answer.inliers);
  estimate.num_explained = static_cast<int>(MatchesThatAgree(problem, pose).size());
  return estimate;
}

}  // namespace

std::vector<int> MatchesThatAgree(const MotionProblem& problem, const RelativePose& pose) {
  const Eigen::Matrix3d F =
      FundamentalFromEssential(EssentialFromPose(pose), problem.camera1, problem.camera2);
  const double bound = ConsistencyThreshold(kSignificanceLevel) * problem.sigma_px * problem.sigma_px;
  std::vector<int> agreeing;
  for (size_t i = 0; i < problem.matches.size(); ++i) {
    if (SquaredSampsonDistance(F, problem.matches[i]) <= bound) agreeing.push_back(static_cast<int>(i));
  }
  return agreeing;
}

std::optional<Matrix5d> CovarianceOfInliers(const MotionProblem& problem, const RelativePose& pose,
                                            const std::vector<int>& inliers) {
  std::vector<Correspondence> fitted;
  for (const int i : inliers) fitted.push_back(problem.matches.at(static_cast<size_t>(i)));
  return FirstOrderMotionCovariance(pose, problem.camera1, problem.camera2, fitted, problem.sigma_px);
}

MotionEstimate CallPeer(const MotionProblem& problem, int sample_size, const std::string& library,
                        const std::function<std::optional<PeerAnswer>()>& ask) {
  if (std::optional<MotionEstimate> refusal = RefuseUnsolvable(problem, sample_size)) return *refusal;
  try {
    std::optional<PeerAnswer> answer = ask();
    if (!answer) return MakeRefusal(MotionStatus::kNoCandidate, library + " found no motion");
    return EstimateFrom(problem, library, std::move(*answer));
  } catch (const std::exception& error) {
    return MakeRefusal(MotionStatus::kLibraryError, fmt::format("{}: {}", library, error.what()));
  }
}

}  // namespace rcme
