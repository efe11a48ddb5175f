// A stand-in for PoseLib 2.0.5, as far as peers/poselib.cc asks: it keeps what it was asked and answers what
// it was told to.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace poselib {

using Point2D = Eigen::Vector2d;

struct Camera {
  std::string model;
  std::vector<double> params;
  int width, height;
  Camera(const std::string& model_name, const std::vector<double>& model_params, int w, int h)
      : model(model_name), params(model_params), width(w), height(h) {}
};

struct CameraPose {
  Eigen::Vector4d q{1.0, 0.0, 0.0, 0.0};  // w, x, y, z
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R() const { return Eigen::Quaterniond(q(0), q(1), q(2), q(3)).toRotationMatrix(); }
};

struct RansacOptions {
  std::size_t max_iterations = 100000, min_iterations = 1000;
  double success_prob = 0.9999, max_epipolar_error = 1.0;
  unsigned long seed = 0;
};
struct BundleOptions {};
struct RansacStats {
  std::size_t num_inliers = 0;
};

struct StandInCall {
  std::vector<Point2D> points1, points2;
  std::vector<Camera> cameras;
  RansacOptions options;
};
struct StandIn {
  std::vector<StandInCall> calls;
  std::function<RansacStats(CameraPose*, std::vector<char>*)> answer;
};
inline StandIn& TheStandIn() {
  static StandIn stand_in;
  return stand_in;
}

inline RansacStats estimate_relative_pose(const std::vector<Point2D>& points1,
                                          const std::vector<Point2D>& points2, const Camera& camera1,
                                          const Camera& camera2, const RansacOptions& options,
                                          const BundleOptions&, CameraPose* pose,
                                          std::vector<char>* inliers) {
  TheStandIn().calls.push_back({points1, points2, {camera1, camera2}, options});
  return TheStandIn().answer(pose, inliers);
}

}  // namespace poselib
