#include "estimator/motion_prior.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "stats/distributions.h"

namespace rcme {
namespace {

constexpr double kUnitTolerance = 1e-4;  // of the length of a vector, and of |R R' - I|

// J^-1(w) of the header; below 0.01 rad its factor by the series 1/12 + a^2 / 720.
Eigen::Matrix3d InverseLeftJacobian(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  const Eigen::Matrix3d cross = CrossMatrix(w);
  const double factor = angle < 1e-2 ? 1.0 / 12.0 + angle * angle / 720.0
                                     : 1.0 / (angle * angle) - 0.5 / (angle * std::tan(0.5 * angle));
  return Eigen::Matrix3d::Identity() - 0.5 * cross + factor * cross * cross;
}

// T(a, b) of the header and its derivative with respect to a. With the unit axis n of the turn it is
//
//   dT = -n (n x a)' da - f (b x n) n' da,
//
// a change of the angle and a turn of the axis. Beyond a right angle f keeps the value it has there: towards
// the opposite of a it grows without bound, but the angle, and so the cost, does not depend on the turn of
// the axis, and J' J would be information that the measurement does not have. For opposite vectors n is not
// unique; this one is an axis of DirectionBasis(a).
struct Turn {
  Eigen::Vector3d vector;
  Eigen::Matrix3d by_from;
};
Turn ComputeTurn(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d axis = a.cross(b);
  const double sin = axis.norm(), cos = a.dot(b), angle = std::atan2(sin, cos);
  if (sin < 1e-9 && cos < 0.0) {
    return {std::numbers::pi * DirectionBasis(a).col(0), Eigen::Matrix3d::Zero()};
  }
  if (cos < 0.0) {
    const Eigen::Vector3d n = axis / sin;
    return {angle * n, -n * n.cross(a).transpose() - 0.5 * std::numbers::pi * b.cross(n) * n.transpose()};
  }
  const double f = sin < 1e-4 ? 1.0 + angle * angle / 6.0 : angle / sin;
  const double derivative =
      sin < 1e-3 ? -1.0 / 3.0 - 2.0 / 15.0 * angle * angle : (cos * f - 1.0) / (sin * sin);
  return {f * axis, derivative * axis * b.transpose() - f * CrossMatrix(b)};
}

bool IsSd(double sd_rad) { return sd_rad >= kLeastPriorSdRad && sd_rad <= kGreatestPriorSdRad; }
bool IsUnit(const Eigen::Vector3d& v) { return std::abs(v.norm() - 1.0) < kUnitTolerance; }

std::string FindRotationFault(const RotationPrior& rotation) {
  const Eigen::Matrix3d misfit = rotation.R * rotation.R.transpose() - Eigen::Matrix3d::Identity();
  if (!(misfit.norm() < kUnitTolerance) || !(rotation.R.determinant() > 0.0))
    return "the rotation of the prior is not a rotation matrix";
  const Eigen::Matrix3d& cov = rotation.cov;
  if (!cov.allFinite() || !((cov - cov.transpose()).norm() <= 1e-9 * cov.norm()))
    return "the covariance of the prior's rotation is not finite and symmetric";
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(cov, Eigen::EigenvaluesOnly);
  const bool is_allowed = IsSd(std::sqrt(std::max(eigen.eigenvalues()(0), 0.0))) &&
                          IsSd(std::sqrt(std::max(eigen.eigenvalues()(2), 0.0)));
  if (is_allowed) return {};
  return fmt::format("a standard deviation of the prior's rotation is outside of [{:g}, {:g}] rad",
                     kLeastPriorSdRad, kGreatestPriorSdRad);
}

std::string FindVectorFault(const char* name, const Eigen::Vector3d& v, double sd_rad) {
  if (!IsUnit(v)) return fmt::format("the prior's {} is not a vector of unit length", name);
  if (IsSd(sd_rad)) return {};
  return fmt::format(
      "the standard deviation of the prior's {} is {} rad; a number in [{:g}, {:g}] is allowed", name, sd_rad,
      kLeastPriorSdRad, kGreatestPriorSdRad);
}

double GravityVariance(const GravityPrior& gravity) {
  return gravity.sd1_rad * gravity.sd1_rad + gravity.sd2_rad * gravity.sd2_rad;
}

}  // namespace

std::string FindPriorFault(const MotionPrior& prior) {
  std::string fault;
  if (!prior.rotation && !prior.gravity && !prior.direction)
    return "the prior is empty; give a rotation, gravity or a direction";
  if (prior.rotation) fault = FindRotationFault(*prior.rotation);
  if (fault.empty() && prior.gravity)
    fault = FindVectorFault("gravity in camera 1", prior.gravity->in_cam1, prior.gravity->sd1_rad);
  if (fault.empty() && prior.gravity)
    fault = FindVectorFault("gravity in camera 2", prior.gravity->in_cam2, prior.gravity->sd2_rad);
  if (fault.empty() && prior.direction)
    fault = FindVectorFault("direction", prior.direction->t, prior.direction->sd_rad);
  return fault;
}

int CountPriorFreedom(const MotionPrior& prior) {
  return (prior.rotation ? 3 : 0) + (prior.gravity ? 2 : 0) + (prior.direction ? 2 : 0);
}

PriorResiduals ComputePriorResiduals(const MotionPrior& prior, const RelativePose& pose) {
  PriorResiduals r;
  if (prior.rotation) {
    const Eigen::LLT<Eigen::Matrix3d> llt(prior.rotation->cov);
    const Eigen::Vector3d w = VectorFromRotation(pose.R * prior.rotation->R.transpose());
    r.residual.head<3>() = llt.matrixL().solve(w);
    r.jacobian.topLeftCorner<3, 3>() = llt.matrixL().solve(InverseLeftJacobian(w));
  }
  if (prior.gravity) {
    const Eigen::Vector3d turned = pose.R * prior.gravity->in_cam1.normalized();
    const Turn turn = ComputeTurn(turned, prior.gravity->in_cam2.normalized());
    const double scale = 1.0 / std::sqrt(GravityVariance(*prior.gravity));
    r.residual.segment<3>(3) = scale * turn.vector;
    r.jacobian.block<3, 3>(3, 0) = -scale * turn.by_from * CrossMatrix(turned);
  }
  if (prior.direction) {
    const Turn turn = ComputeTurn(pose.t, prior.direction->t.normalized());
    const double scale = 1.0 / prior.direction->sd_rad;
    r.residual.tail<3>() = scale * turn.vector;
    r.jacobian.bottomRightCorner<3, 2>() = scale * turn.by_from * DirectionBasis(pose.t);
  }
  return r;
}

PriorTerms EvaluatePrior(const MotionPrior& prior, const RelativePose& pose) {
  const PriorResiduals r = ComputePriorResiduals(prior, pose);
  return {0.5 * r.residual.squaredNorm(), r.jacobian.transpose() * r.residual,
          r.jacobian.transpose() * r.jacobian};
}

double LogPeakOverUniform(const MotionPrior& prior) {
  constexpr double kTwoPi = 2.0 * std::numbers::pi;
  double log_peak = 0.0;
  if (prior.rotation) {
    const double log_det = std::log(std::max(prior.rotation->cov.determinant(), 1e-300));
    log_peak += std::max(std::log(2.0 * kTwoPi * kTwoPi) - 1.5 * std::log(kTwoPi) - 0.5 * log_det, 0.0);
  }
  if (prior.gravity) log_peak += std::max(std::log(2.0 / GravityVariance(*prior.gravity)), 0.0);
  if (prior.direction)
    log_peak += std::max(std::log(2.0 / (prior.direction->sd_rad * prior.direction->sd_rad)), 0.0);
  return log_peak;
}

double ComputePriorTail(const MotionPrior& prior, const RelativePose& pose, const Matrix5d& pose_cov) {
  const PriorResiduals r = ComputePriorResiduals(prior, pose);
  const Eigen::Matrix<double, 9, 9> spread =
      Eigen::Matrix<double, 9, 9>::Identity() + r.jacobian * pose_cov * r.jacobian.transpose();
  const Eigen::LLT<Eigen::Matrix<double, 9, 9>> llt(spread);
  const double chi_square = r.residual.dot(llt.solve(r.residual));
  if (llt.info() != Eigen::Success || !std::isfinite(chi_square)) return 1.0;  // it contradicts nothing
  return 1.0 - ChiSquareCdf(CountPriorFreedom(prior), chi_square);
}

double ComputePriorAgreement(const MotionPrior& prior) {
  if (!prior.rotation || !prior.gravity) return 1.0;
  Matrix5d measured_cov = Matrix5d::Zero();
  measured_cov.topLeftCorner<3, 3>() = prior.rotation->cov;
  return ComputePriorTail({.gravity = prior.gravity}, {prior.rotation->R, Eigen::Vector3d::UnitZ()},
                          measured_cov);
}

std::vector<double> ListPriorNumbers(const MotionPrior& prior) {
  std::vector<double> numbers;
  const auto add = [&](const auto& more) { numbers.insert(numbers.end(), more.begin(), more.end()); };
  for (const bool is_there :
       {prior.rotation.has_value(), prior.gravity.has_value(), prior.direction.has_value()})
    numbers.push_back(is_there ? 1.0 : 0.0);
  if (prior.rotation) {
    add(prior.rotation->R.reshaped());
    add(prior.rotation->cov.reshaped());
  }
  if (prior.gravity) {
    add(prior.gravity->in_cam1);
    add(prior.gravity->in_cam2);
    numbers.push_back(prior.gravity->sd1_rad);
    numbers.push_back(prior.gravity->sd2_rad);
  }
  if (prior.direction) {
    add(prior.direction->t);
    numbers.push_back(prior.direction->sd_rad);
  }
  return numbers;
}

}  // namespace rcme
