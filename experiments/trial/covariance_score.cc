#include "experiments/trial/covariance_score.h"

#include <algorithm>

#include "stats/consistency.h"

namespace rcme {

RelativePose NearestPose(const std::array<RelativePose, 4>& poses, const RelativePose& pose_true) {
  const auto distance = [&](const RelativePose& pose) { return LocalCoordinates(pose_true, pose).norm(); };
  return *std::min_element(poses.begin(), poses.end(), [&](const RelativePose& a, const RelativePose& b) {
    return distance(a) < distance(b);
  });
}

double NormalizedErrorOfF(const LinearMotion& estimate, const RelativePose& pose_true) {
  return NormalizedErrorSquared(estimate.fit.LocalCoordinates(ComputeLinearModel(pose_true)),
                                estimate.LocalCovarianceOfF());
}

double NormalizedErrorOfPose(const RelativePose& estimate, const Matrix5d& pose_cov,
                             const RelativePose& pose_true) {
  return NormalizedErrorSquared(LocalCoordinates(estimate, pose_true), pose_cov);
}

}  // namespace rcme
