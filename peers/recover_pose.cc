#include "peers/recover_pose.h"

#include <opencv2/calib3d.hpp>

namespace rcme {

CvPoints ListPixels(const MotionProblem& problem) {
  CvPoints points;
  for (const Correspondence& match : problem.matches) {
    points.image1.emplace_back(match.x1_px.x(), match.x1_px.y());
    points.image2.emplace_back(match.x2_px.x(), match.x2_px.y());
  }
  return points;
}

cv::Matx33d CvMatrix(const Eigen::Matrix3d& matrix) {
  cv::Matx33d cv_matrix;
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) cv_matrix(row, col) = matrix(row, col);
  }
  return cv_matrix;
}

std::optional<PeerAnswer> RecoverPose(const MotionProblem& problem, const cv::Mat& E, const cv::Mat& mask,
                                      double max_depth) {
  CvPoints rays;  // recoverPose takes a single K, so give it rays
  for (const Correspondence& match : problem.matches) {
    const Eigen::Vector3d ray1 = problem.camera1.Ray(match.x1_px), ray2 = problem.camera2.Ray(match.x2_px);
    rays.image1.emplace_back(ray1.x(), ray1.y());
    rays.image2.emplace_back(ray2.x(), ray2.y());
  }
  cv::Mat R, t, in_front = mask.clone();
  if (cv::recoverPose(E, rays.image1, rays.image2, cv::Matx33d::eye(), R, t, max_depth, in_front) < 1)
    return std::nullopt;
  PeerAnswer answer;
  for (int row = 0; row < 3; ++row) {
    answer.cam2_from_cam1.t(row) = t.at<double>(row);
    for (int col = 0; col < 3; ++col) answer.cam2_from_cam1.R(row, col) = R.at<double>(row, col);
  }
  for (int i = 0; i < static_cast<int>(in_front.total()); ++i) {
    if (in_front.at<unsigned char>(i)) answer.inliers.push_back(i);
  }
  return answer;
}

Parameter MaxDepthParameter(double* max_depth) {
  return Parameter::Real(
      "max_depth", max_depth, {1e-3, 1e9}, "baselines",
      "farther points are no inliers and do not vote on the direction's sign (recoverPose's "
      "distanceThresh)");
}

}  // namespace rcme
