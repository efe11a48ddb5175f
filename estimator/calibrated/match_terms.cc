#include "estimator/calibrated/match_terms.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "estimator/geometry/sampson.h"

namespace rcme {
namespace {

// Variance of the angle between two rays, rad^2: the noise of both, averaged over fx and fy.
double AngleVariance(const MotionProblem& problem) {
  double sum = 0.0;
  for (const Camera& camera : {problem.camera1, problem.camera2}) {
    for (const double focal : {camera.fx, camera.fy}) sum += std::pow(problem.sigma_px / focal, 2);
  }
  return 0.5 * sum;
}

// The component of the parallax a x b within the epipolar plane of `ray`, rad.
double ParallaxWithin(const Eigen::Vector3d& ray, const Eigen::Vector3d& t, const Eigen::Vector3d& a,
                      const Eigen::Vector3d& b) {
  return ray.cross(t).normalized().dot(a.cross(b)) / (a.norm() * b.norm());
}

}  // namespace

MatchTerms EvaluateMatch(const MotionProblem& problem, const RelativePose& pose, const Correspondence& match,
                         double noise_scale) {
  const Eigen::Matrix3d F =
      FundamentalFromEssential(EssentialFromPose(pose), problem.camera1, problem.camera2);
  const EpipolarConstraint c = EvaluateConstraint(F, match);
  const double length = std::sqrt(c.squared_gradient()) * noise_scale;
  MatchTerms terms;
  terms.residual = c.g / (length * problem.sigma_px);
  const std::array<Eigen::Matrix3d, 5> dE = EssentialTangent(pose);
  for (size_t k = 0; k < 5; ++k) {
    const EpipolarConstraint d =
        EvaluateConstraint(FundamentalFromEssential(dE[k], problem.camera1, problem.camera2), match);
    const double slope = d.g - c.g / c.squared_gradient() * c.gradient.dot(d.gradient);
    terms.derivative(static_cast<Eigen::Index>(k)) = slope / (length * problem.sigma_px);
  }
  const Eigen::Vector3d a = pose.R * problem.camera1.Ray(match.x1_px);
  const Eigen::Vector3d b = problem.camera2.Ray(match.x2_px);
  const double noise_rad = std::sqrt(AngleVariance(problem)) * noise_scale;
  const double depth1 = ParallaxWithin(b, pose.t, a, b) / noise_rad;
  const double depth2 = ParallaxWithin(a, pose.t, a, b) / noise_rad;
  terms.depth = std::min(depth1, depth2);
  terms.mean_depth = 0.5 * (depth1 + depth2);
  return terms;
}

MatchDensity EvaluateDensity(double residual, double depth, const MixtureParameters& parameters,
                             double noise_scale) {
  const NoiseLaw& noise = parameters.noise;
  const double u = residual / parameters.scale;
  const double law = noise.peak * std::pow(1.0 + u * u / noise.dof(), -noise.power);
  const double inlier =
      parameters.inlier_ratio * law * CheiralityFactor(depth / parameters.scale) / parameters.scale;
  MatchDensity of_match;
  of_match.density = inlier + (1.0 - parameters.inlier_ratio) * parameters.outlier_density * noise_scale;
  const double p = of_match.right = inlier / of_match.density;
  const double v = of_match.weight = 2.0 * noise.power / (noise.dof() + u * u);
  const double psi = v * u, psi_slope = v * (noise.dof() - u * u) / (noise.dof() + u * u);
  of_match.curvature = std::max(p * psi_slope - p * (1.0 - p) * psi * psi, 0.6 * p * v);
  return of_match;
}

double SoftScore(double residual, double scale) {
  return 1.0 / (1.0 + residual * residual / (scale * scale));
}

}  // namespace rcme
