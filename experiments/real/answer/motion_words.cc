#include "experiments/real/answer/motion_words.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "stats/constants.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

// A positive rotation about x (right) turns the camera up, about y (down) to the right, about z (forward)
// clockwise as seen by somebody who looks forward.
constexpr std::array<std::array<const char*, 2>, 3> kTurns = {
    {{"up", "down"}, {"to the right", "to the left"}, {"clockwise", "anticlockwise"}}};
constexpr std::array<std::array<const char*, 2>, 3> kSides = {
    {{"right", "left"}, {"below", "above"}, {"forward", "backward"}}};

// Returns the axes along which the vector has at least `least`, the greatest first.
std::vector<int> AxesBySize(const Eigen::Vector3d& vector, double least) {
  std::vector<int> axes;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(vector(axis)) >= least) axes.push_back(axis);
  }
  std::ranges::stable_sort(axes, std::ranges::greater{}, [&](int axis) { return std::abs(vector(axis)); });
  return axes;
}

// Returns the standard deviations along the principal axes of a covariance in deg, greatest first.
template <int size>
Eigen::Matrix<double, size, 1> PrincipalSdDeg(const Eigen::Matrix<double, size, size>& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, size, size>> solver(covariance);
  return kDegPerRad * solver.eigenvalues().reverse().cwiseMax(0.0).cwiseSqrt();
}

}  // namespace

Turn ComputeTurn(const Eigen::Matrix3d& cam2_from_cam1_R) {
  const Eigen::Vector3d w_deg = kDegPerRad * VectorFromRotation(cam2_from_cam1_R.transpose());
  Turn turn;
  turn.angle_deg = w_deg.norm();
  if (turn.angle_deg > 0.0) turn.axis_in_cam1 = w_deg / turn.angle_deg;
  for (const int axis : AxesBySize(w_deg, 0.1 * turn.angle_deg)) {
    const char* way = kTurns[static_cast<size_t>(axis)][w_deg(axis) < 0.0];
    turn.words += fmt::format("{}{:.3g} deg {}", turn.words.empty() ? "" : ", ", std::abs(w_deg(axis)), way);
  }
  return turn;
}

Eigen::Vector3d ComputePlace(const RelativePose& cam2_from_cam1) {
  return -(cam2_from_cam1.R.transpose() * cam2_from_cam1.t);
}

std::string DescribePlace(const RelativePose& cam2_from_cam1) {
  const Eigen::Vector3d place = ComputePlace(cam2_from_cam1);
  std::string words;
  for (const int axis : AxesBySize(place, 0.3))
    words += std::string(words.empty() ? "" : ", ") + kSides[static_cast<size_t>(axis)][place(axis) < 0.0];
  return words;
}

MotionSpread ComputeSpread(const RelativePose& cam2_from_cam1, const Matrix5d& pose_cov) {
  const Eigen::Matrix3d rotation_cov = pose_cov.topLeftCorner<3, 3>();
  const Eigen::Matrix2d direction_cov = pose_cov.bottomRightCorner<2, 2>();
  // R <- Exp(w) R rotates in camera 2's frame. The axis of R has the same coordinates in both frames.
  const Eigen::Vector3d axis = ComputeTurn(cam2_from_cam1.R).axis_in_cam1;
  MotionSpread spread;
  spread.angle_sd_deg = kDegPerRad * std::sqrt(std::max(axis.dot(rotation_cov * axis), 0.0));
  spread.rotation_95_deg = std::sqrt(ChiSquareQuantile(3, 0.95)) * PrincipalSdDeg<3>(rotation_cov);
  spread.direction_sd_deg = PrincipalSdDeg<2>(direction_cov);
  spread.direction_95_deg = std::sqrt(ChiSquareQuantile(2, 0.95)) * spread.direction_sd_deg;
  return spread;
}

const MotionMode* FindRunnerUp(const MotionEstimate& estimate) {
  constexpr double kSameWithin = 0.1;
  const Vector5d variances = estimate.pose_cov.diagonal();
  const double rotation_sd = std::sqrt(variances.head<3>().sum()),
               direction_sd = std::sqrt(variances.tail<2>().sum());
  const RelativePose& answer = estimate.cam2_from_cam1;
  for (const MotionMode& mode : estimate.other_modes) {
    const RelativePose& other = mode.cam2_from_cam1;
    if (RotationAngleBetween(other.R, answer.R) > kSameWithin * rotation_sd ||
        AngleBetween(other.t, answer.t) > kSameWithin * direction_sd)
      return &mode;
  }
  return nullptr;
}

}  // namespace rcme
