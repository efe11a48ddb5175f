// Prior knowledge of a motion: a rotation from a gyroscope, the direction of gravity in both cameras, a
// direction of translation from wheels or from the previous motion. Each part is optional, and a measurement
// with Gaussian noise.
//
//   rotation    true R = Exp(w) R, w ~ N(0, cov), in the axes of camera 2 as in pose_cov
//   gravity     unit vectors g1 and g2 with g2 = R g1, each turned by isotropic noise (rad); fixes two of the
//               three degrees of freedom of R, all but the turn about gravity
//   direction   a unit vector t, turned by isotropic noise (rad)
//
// The residuals at a motion (R, t), in units of their standard deviations, are rotation vectors in camera 2's
// frame. With T(a, b) the shortest turn from the unit vector a to b,
//
//   rotation    L^-1 Log(R R_measured'),  L L' = cov
//   gravity     T(R g1, g2) / sqrt(sd1^2 + sd2^2), as the noises of g1 and g2 add up
//   direction   T(t, t_measured) / sd
//
// so that the density of the measurements is exp(-|r|^2 / 2) up to a constant. Derivatives along the tangent
// of a motion (geometry/pose.h), R <- Exp(d) R and t <- t + B b:
//
//   Log(Exp(d) Exp(w)) = w + J^-1(w) d + ...,
//   J^-1(w) = I - [w]x / 2 + (1 / a^2 - cot(a / 2) / (2 a)) [w]x^2,  a = |w|   (left Jacobian of SO(3))
//   T(a, b) = f(c) a x b,  c = a'b = cos(angle),  f = angle / sin(angle),
//   dT = f'(c) (a x b) (b' da) - f [b]x da,       f'(c) = (c f - 1) / sin^2(angle),
//   da = d x R g1 = -[R g1]x d for gravity, and B b for the direction
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "estimator/geometry/pose.h"

namespace rcme {

struct RotationPrior {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d cov = Eigen::Matrix3d::Identity();  // rad^2
};
struct GravityPrior {
  Eigen::Vector3d in_cam1 = Eigen::Vector3d::UnitY(), in_cam2 = Eigen::Vector3d::UnitY();
  double sd1_rad = 1.0, sd2_rad = 1.0;
};
struct DirectionPrior {
  Eigen::Vector3d t = Eigen::Vector3d::UnitZ();
  double sd_rad = 1.0;
};
struct MotionPrior {
  std::optional<RotationPrior> rotation = {};
  std::optional<GravityPrior> gravity = {};
  std::optional<DirectionPrior> direction = {};
};

// Range of accepted standard deviations; its lower end is above the rounding of R and t.
inline constexpr double kLeastPriorSdRad = 1e-6, kGreatestPriorSdRad = 1e6;

// A message that says why the prior cannot be used and what is allowed; empty if it can be used.
std::string FindPriorFault(const MotionPrior& prior);

// Degrees of freedom of the parts present: 3 for the rotation, 2 for gravity, 2 for the direction.
int CountPriorFreedom(const MotionPrior& prior);

// Three rows each for rotation, gravity and direction; rows of absent parts are zero.
struct PriorResiduals {
  Eigen::Matrix<double, 9, 1> residual = Eigen::Matrix<double, 9, 1>::Zero();
  Eigen::Matrix<double, 9, 5> jacobian = Eigen::Matrix<double, 9, 5>::Zero();
};
PriorResiduals ComputePriorResiduals(const MotionPrior& prior, const RelativePose& pose);

struct PriorTerms {
  double cost = 0.0;                     // |r|^2 / 2
  Vector5d gradient = Vector5d::Zero();  // J' r
  Matrix5d hessian = Matrix5d::Zero();   // J' J (Gauss-Newton)
};
PriorTerms EvaluatePrior(const MotionPrior& prior, const RelativePose& pose);

// Sum over the parts of the log ratio between the peak density of the measurement and the uniform density
// (over rotations, or over the sphere). A negative term counts as 0. For small noise the terms are
//   rotation   log(8 pi^2 / sqrt((2 pi)^3 det cov)),  8 pi^2 the volume of the rotations in rotation vectors
//   gravity    log(4 pi / (2 pi (sd1^2 + sd2^2))),    direction   log(4 pi / (2 pi sd^2))
double LogPeakOverUniform(const MotionPrior& prior);

// The probability that measurements of a motion N(pose, pose_cov) depart from it at least as far as these:
// the upper tail of chi-square at r' (I + J pose_cov J')^-1 r, with CountPriorFreedom degrees of freedom.
double ComputePriorTail(const MotionPrior& prior, const RelativePose& pose, const Matrix5d& pose_cov);

// The probability that measurements of one motion, its rotation and the direction of gravity, depart from
// each other at least as far as these; 1 unless the prior has both. (No other parts measure the same.)
double ComputePriorAgreement(const MotionPrior& prior);

// All numbers of a prior; two lists are equal only if the priors are.
std::vector<double> ListPriorNumbers(const MotionPrior& prior);

}  // namespace rcme
