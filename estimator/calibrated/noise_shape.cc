#include "estimator/calibrated/noise_shape.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "estimator/geometry/sampson.h"

namespace rcme {
namespace {

constexpr size_t kMostDirected = 512, kLeastDirected = 20;
constexpr int kScaleSteps = 3, kShapeSteps = 8;
constexpr double kPriorPrecision = 4.0;  // of b and c
constexpr double kGreatestShape = 0.99;  // of |(b, c)|: a ratio of the standard deviations of 14
// Gain, to second order, below which the noise is taken for isotropic without a fit.
constexpr double kLeastPredictedGain = 6.0;

// The residual of a match and the direction of its lines.
struct DirectedResidual {
  double square;  // r^2, in units of the assumed variance of this match
  double x, y;
};

std::vector<DirectedResidual> ListResiduals(const MotionProblem& problem, const ExplainedMode& mode) {
  const Eigen::Matrix3d F =
      FundamentalFromEssential(EssentialFromPose(mode.mode.pose), problem.camera1, problem.camera2);
  std::vector<DirectedResidual> residuals;
  residuals.reserve(std::min(problem.matches.size(), kMostDirected));
  for (size_t i = 0; i < problem.matches.size() && residuals.size() < kMostDirected; ++i) {
    if (!(mode.explanation.probability[i] > 0.5)) continue;
    const Eigen::Vector4d J = EvaluateConstraint(F, problem.matches[i]).gradient;
    const double inverse = 1.0 / J.squaredNorm(), r = mode.explanation.terms.residual[i];
    residuals.push_back({r * r, inverse * (J(0) * J(0) - J(1) * J(1) + J(2) * J(2) - J(3) * J(3)),
                         2.0 * inverse * (J(0) * J(1) + J(2) * J(3))});
  }
  return residuals;
}

// ln s^2, b and c.
using LogScaleAndShape = Eigen::Vector3d;

// The log density of the residuals times that of the prior, its gradient and its expected information.
struct ShapeSums {
  double log_posterior = 0.0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
};
ShapeSums SumShape(const std::vector<DirectedResidual>& residuals, const NoiseLaw& law,
                   const LogScaleAndShape& shape) {
  ShapeSums sums;
  const double s2 = std::exp(shape(0)), dof = law.dof(), power = law.power;
  for (const DirectedResidual& residual : residuals) {
    const double by_direction = 1.0 + shape(1) * residual.x + shape(2) * residual.y;
    const double u2 = residual.square / (s2 * by_direction);
    const double weighted = 2.0 * power * u2 / (dof + u2);
    const Eigen::Vector3d slope(1.0, residual.x / by_direction, residual.y / by_direction);  // of ln q
    sums.log_posterior -= 0.5 * std::log(by_direction) + power * std::log1p(u2 / dof);
    sums.gradient += 0.5 * (weighted - 1.0) * slope;
    sums.information += dof / (2.0 * (dof + 3.0)) * slope * slope.transpose();
  }
  sums.log_posterior -= 0.5 * static_cast<double>(residuals.size()) * shape(0);
  sums.log_posterior -= 0.5 * kPriorPrecision * shape.tail<2>().squaredNorm();
  sums.gradient.tail<2>() -= kPriorPrecision * shape.tail<2>();
  sums.information.bottomRightCorner<2, 2>().diagonal().array() += kPriorPrecision;
  return sums;
}

LogScaleAndShape Clip(LogScaleAndShape shape) {
  const double size = shape.tail<2>().norm();
  if (size > kGreatestShape) shape.tail<2>() *= kGreatestShape / size;
  return shape;
}

}  // namespace

Eigen::Matrix2d NoiseShape::Covariance() const {
  Eigen::Matrix2d covariance;
  covariance << 1.0 + b, c, c, 1.0 - b;
  return covariance;
}

std::optional<NoiseShape> FitNoiseShape(const MotionProblem& problem, const ExplainedMode& mode) {
  const std::vector<DirectedResidual> residuals = ListResiduals(problem, mode);
  if (residuals.size() < kLeastDirected) return std::nullopt;
  const NoiseLaw& law = mode.mode.mixture.noise;
  LogScaleAndShape at(2.0 * std::log(mode.mode.mixture.scale), 0.0, 0.0);
  ShapeSums sums = SumShape(residuals, law, at);
  for (int step = 0; step < kScaleSteps; ++step) {  // the best isotropic noise
    at(0) += sums.gradient(0) / sums.information(0, 0);
    sums = SumShape(residuals, law, at);
  }
  const double isotropic = sums.log_posterior;
  if (!(0.5 * sums.gradient.dot(sums.information.ldlt().solve(sums.gradient)) >= kLeastPredictedGain))
    return std::nullopt;
  double fraction = 1.0;  // of a step of Fisher scoring
  for (int step = 0; step < kShapeSteps; ++step) {
    const LogScaleAndShape there = Clip(at + fraction * sums.information.ldlt().solve(sums.gradient));
    const ShapeSums tried = SumShape(residuals, law, there);
    if (!(tried.log_posterior >= sums.log_posterior)) {
      fraction *= 0.5;
      continue;
    }
    at = there;
    sums = tried;
  }
  const double gain = sums.log_posterior - isotropic;
  const double all_over_used = mode.explanation.num_explained / static_cast<double>(residuals.size());
  return NoiseShape{at(1), at(2), gain, gain * std::max(all_over_used, 1.0)};
}

bool IsNoiseAnisotropic(const NoiseShape& shape, const ModelCheck& check) {
  constexpr double kLeastGain = 12.0, kLeastShape = 0.25, kGreatestNeighbourZ = 7.0, kClippedRoot = 30.0;
  const double by_calibration = 0.5 * check.calibration.root_gain * check.calibration.root_gain;  // nats
  return shape.gain >= kLeastGain && std::hypot(shape.b, shape.c) >= kLeastShape &&
         shape.gain_of_all >= by_calibration && check.calibration.root_gain < kClippedRoot &&
         std::abs(check.neighbour_z) <= kGreatestNeighbourZ;
}

}  // namespace rcme
