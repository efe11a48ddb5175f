#include "estimator/calibrated/twisted_pair.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "estimator/geometry/triangulation.h"
#include "estimator/noise_scale.h"

namespace rcme {
namespace {

constexpr int kRefits = 5;
constexpr size_t kMostSamples = 128;  // first matches that the plane is fitted to; their order must be random
// Standard deviations of the parallax within which a match belongs to the plane.
constexpr double kTwistPlaneBound = 3.0;

struct DepthSample {
  Eigen::Vector3d ray1;
  double inverse_depth, sd, weight;  // the weight is the probability that the match is right
};

// |d ray2 / d rho| of a point at ray1 and inverse depth rho: the parallax of one baseline at unit depth.
double ParallaxPerInverseDepth(const RelativePose& pose, const Eigen::Vector3d& ray1) {
  const Eigen::Vector3d a = pose.R * ray1;
  return a.cross(pose.t).norm() / a.squaredNorm();
}

std::vector<DepthSample> DepthSamples(const MotionProblem& problem, const RelativePose& pose,
                                      const std::vector<double>& probability) {
  const double noise_rad = problem.sigma_px * std::sqrt(1.0 / (problem.camera1.fx * problem.camera1.fy) +
                                                        1.0 / (problem.camera2.fx * problem.camera2.fy));
  std::vector<DepthSample> samples;
  for (size_t i = 0; i < problem.matches.size() && samples.size() < kMostSamples; ++i) {
    if (probability[i] < 0.5) continue;
    const Eigen::Vector3d ray1 = problem.camera1.Ray(problem.matches[i].x1_px);
    const Eigen::Vector3d ray2 = problem.camera2.Ray(problem.matches[i].x2_px);
    const double gain = ParallaxPerInverseDepth(pose, ray1);
    if (!(gain > 1e-9)) continue;
    const double sd = noise_rad * NoiseScaleAt(problem, i) / gain;
    samples.push_back({ray1, InverseDepth(pose, ray1, ray2), sd, probability[i]});
  }
  return samples;
}

}  // namespace

std::optional<VisiblePlane> FindPlane(const MotionProblem& problem, const RelativePose& pose,
                                      const std::vector<double>& probability, double least_share) {
  const std::vector<DepthSample> samples = DepthSamples(problem, pose, probability);
  if (samples.size() < 5) return std::nullopt;
  Eigen::Vector3d plane = Eigen::Vector3d::Zero(), sum_of_near;
  int num_near = 0;
  for (int refit = 0; refit <= kRefits; ++refit) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    num_near = 0;
    sum_of_near.setZero();
    for (const DepthSample& sample : samples) {
      const double u = (sample.inverse_depth - plane.dot(sample.ray1)) / sample.sd;
      if (std::abs(u) <= kTwistPlaneBound) ++num_near, sum_of_near += sample.ray1;
      const double robust = refit == 0 ? 1.0 : 1.0 / (1.0 + u * u / (kTwistPlaneBound * kTwistPlaneBound));
      const double weight = robust * robust * sample.weight / (sample.sd * sample.sd);
      information += weight * sample.ray1 * sample.ray1.transpose();
      moment += weight * sample.inverse_depth * sample.ray1;
    }
    plane = information.ldlt().solve(moment);
    if (!plane.allFinite()) return std::nullopt;
  }
  if (num_near < least_share * static_cast<double>(samples.size())) return std::nullopt;
  return VisiblePlane{plane, sum_of_near / std::max(num_near, 1)};
}

std::optional<RelativePose> OtherMotionOfPlane(const RelativePose& pose, const VisiblePlane& plane) {
  const Eigen::Matrix3d H0 = pose.R + pose.t * plane.n.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(Eigen::Matrix3d(H0.transpose() * H0));
  const double middle = std::sqrt(eigen.eigenvalues()(1));
  if (!(middle > 1e-9)) return std::nullopt;
  const Eigen::Matrix3d H = H0 / middle;
  const double largest = eigen.eigenvalues()(2) / (middle * middle);
  const double least = eigen.eigenvalues()(0) / (middle * middle);
  const double spread = largest - least;
  if (!(spread > 1e-12)) return std::nullopt;
  // V = [v1 v2 v3] a rotation, singular values descending.
  Eigen::Vector3d v1 = eigen.eigenvectors().col(2), v2 = eigen.eigenvectors().col(1);
  const Eigen::Vector3d v3 = v1.cross(v2);
  const double a = std::sqrt(std::max(1.0 - least, 0.0) / spread),
               b = std::sqrt(std::max(largest - 1.0, 0.0) / spread);
  std::optional<RelativePose> other;
  double furthest = 0.0;
  for (const double sign : {1.0, -1.0}) {
    const Eigen::Vector3d u = a * v1 + sign * b * v3;  // H keeps its length
    Eigen::Matrix3d U, W;
    U << v2, u, v2.cross(u);
    W << H * v2, H * u, (H * v2).cross(H * u);
    const Eigen::Matrix3d R = W * U.transpose();
    const Eigen::Vector3d normal = v2.cross(u);
    Eigen::Vector3d t = (H - R) * normal;
    // The plane n with t n' = H - R is normal or -normal. Its points lie in front of camera 1: n'ray1 > 0.
    if (normal.dot(plane.ray1) < 0.0) t = -t;
    if (!(t.norm() > 1e-9)) continue;
    const RelativePose found{R, t.normalized()};
    const double distance = LocalCoordinates(pose, found).norm();
    if (distance <= furthest) continue;
    furthest = distance;
    other = found;
  }
  return other;
}

}  // namespace rcme
