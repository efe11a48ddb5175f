// What is known of a motion beside the matches: a rotation from a gyroscope, the direction of gravity in both
// cameras, a direction of travel from wheels or from the motion before. Each is a measurement with Gaussian
// noise; each is optional.
//
//   rotation    true R = Exp(w) R, w ~ N(0, cov): the side and the axes (camera 2's) are those of pose_cov
//   gravity     unit vectors g1 and g2 with g2 = R g1, each turned by noise of its own (isotropic, in rad):
//               two of the three degrees of freedom of R; a turn about gravity is not seen
//   direction   a unit vector t, turned by isotropic noise
//
// The residuals at a motion (R, t), in units of their standard deviations, are rotation vectors, in camera
// 2's frame. With T(a, b) the shortest turn that takes the unit vector a to b,
//
//   rotation    L^-1 Log(R R_measured'),  L L' = cov
//   gravity     T(R g1, g2) / sqrt(sd1^2 + sd2^2): the turn of R g1 by the noise of g1 and that of g2 add up
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

// Standard deviations that are accepted: rounding of R and t is below the least.
inline constexpr double kLeastPriorSdRad = 1e-6, kGreatestPriorSdRad = 1e6;

// Why the prior cannot be used, in words that say what is allowed; empty: it can.
std::string FindPriorFault(const MotionPrior& prior);

// Of the parts that are there: 3 for the rotation, 2 for gravity, 2 for the direction.
int CountPriorFreedom(const MotionPrior& prior);

// Three rows each for rotation, gravity and direction; zero for parts that are not there.
struct PriorResiduals {
  Eigen::Matrix<double, 9, 1> residual = Eigen::Matrix<double, 9, 1>::Zero();
  Eigen::Matrix<double, 9, 5> jacobian = Eigen::Matrix<double, 9, 5>::Zero();
};
PriorResiduals ComputePriorResiduals(const MotionPrior& prior, const RelativePose& pose);

struct PriorTerms {
  double cost = 0.0;                     // -log density, zero where all measurements are met: |r|^2 / 2
  Vector5d gradient = Vector5d::Zero();  // J' r
  Matrix5d hessian = Matrix5d::Zero();   // J' J (Gauss-Newton)
};
PriorTerms EvaluatePrior(const MotionPrior& prior, const RelativePose& pose);

// Logarithm of the greatest density of the measurements over that of measurements which know nothing of the
// motion (uniform over rotations and over the sphere), each part at least 0: for a small noise
//   rotation   log(8 pi^2 / sqrt((2 pi)^3 det cov)),  8 pi^2 the volume of the rotations in rotation vectors
//   gravity    log(4 pi / (2 pi (sd1^2 + sd2^2))),    direction   log(4 pi / (2 pi sd^2))
double LogPeakOverUniform(const MotionPrior& prior);

// The probability that measurements of a motion N(pose, pose_cov) depart from it at least as far as these:
// the upper tail of chi-square at r' (I + J pose_cov J')^-1 r.
double ComputePriorTail(const MotionPrior& prior, const RelativePose& pose, const Matrix5d& pose_cov);

// All numbers of a prior: equal for equal priors alone.
std::vector<double> ListPriorNumbers(const MotionPrior& prior);

}  // namespace rcme
