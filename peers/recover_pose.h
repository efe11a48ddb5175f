// Conversion to OpenCV's types, and its step from an essential matrix to a motion.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "estimator/motion_problem.h"
#include "parameters/parameter.h"
#include "peers/peer_call.h"

namespace rcme {

// The points of both images in pixels, with the same origin in OpenCV: the centre of the top-left pixel.
struct CvPoints {
  std::vector<cv::Point2d> image1, image2;
};
CvPoints ListPixels(const MotionProblem& problem);

cv::Matx33d CvMatrix(const Eigen::Matrix3d& matrix);

// The motion of an essential matrix that puts the most matches of `mask` (n x 1, bytes) in front of both
// cameras, by cv::recoverPose; these matches are the inliers. nullopt if there is none. Points farther away
// than `max_depth` baselines do not count; cv::recoverPose without this argument uses 50.
std::optional<PeerAnswer> RecoverPose(const MotionProblem& problem, const cv::Mat& E, const cv::Mat& mask,
                                      double max_depth);

// The option max_depth.
inline constexpr double kDefaultMaxDepth = 50.0;
Parameter MaxDepthParameter(double* max_depth);

}  // namespace rcme
