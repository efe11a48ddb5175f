// OpenCV's matches, and its way from an essential matrix to a motion.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "estimator/motion_problem.h"
#include "parameters/parameter.h"
#include "peers/peer_call.h"

namespace rcme {

// The points of both images: pixels, whose origin OpenCV too has in the centre of the top-left one.
struct CvPoints {
  std::vector<cv::Point2d> image1, image2;
};
CvPoints ListPixels(const MotionProblem& problem);

cv::Matx33d CvMatrix(const Eigen::Matrix3d& matrix);

// The motion of an essential matrix that puts most matches of `mask` (n x 1, bytes) in front of both cameras,
// by cv::recoverPose; inliers are these. Nothing if there is none. Points farther away than `max_depth`
// baselines do not count; cv::recoverPose without that argument takes 50.
std::optional<PeerAnswer> RecoverPose(const MotionProblem& problem, const cv::Mat& E, const cv::Mat& mask,
                                      double max_depth);

// The option for it.
inline constexpr double kDefaultMaxDepth = 50.0;
Parameter MaxDepthParameter(double* max_depth);

}  // namespace rcme
