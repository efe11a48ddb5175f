#pragma once

#include "estimator/motion_estimate.h"
#include "estimator/refinement/sampson_mle.h"

namespace rcme {

// The fit to all matches of a problem without wrong ones.
inline MotionEstimate FitAllMatches(const MotionProblem& problem, const RelativePose& start) {
  const RefinedMotion motion = RefineAllBySampson(problem, start);
  MotionEstimate estimate;
  estimate.status = MotionStatus::kOk;
  estimate.cam2_from_cam1 = motion.cam2_from_cam1;
  estimate.pose_cov = motion.pose_cov;
  for (int i = 0; i < static_cast<int>(problem.matches.size()); ++i) estimate.inliers.push_back(i);
  return estimate;
}

}  // namespace rcme
