#include "estimator/calibrated/direction_axis.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "estimator/noise_scale.h"
#include "stats/order_statistic.h"

namespace rcme {
namespace {

constexpr size_t kMostMatches = 256;
constexpr int kSteps = 3;
constexpr double kShareWrong = 0.02;                    // of the matches that the mode explains
constexpr double kFirstNear = 0.1, kLeastNear = 0.005;  // share of matches with a parallax of any size
constexpr double kBand = 6.0;  // half width, in standard deviations across, of the band of a mode's matches
constexpr double kRootTwoPi = 2.5066282746310002;

// Adds the problem's prior: the direction by itself, all else linearised at the mode's rotation.
void AddPrior(const MotionProblem& problem, const RelativePose& pose, DisplacementSet* set) {
  if (!problem.prior) return;
  MotionPrior prior = *problem.prior;
  set->of_direction = prior.direction;
  prior.direction.reset();
  if (CountPriorFreedom(prior) > 0) set->of_rotation = ComputePriorResiduals(prior, pose);
}

// Squared size of a pixel, rad^2: the mean over the image's axes, and what it is more along x, y and z.
struct PixelSize {
  double mean;
  Eigen::Vector3d excess;
};
PixelSize ComputePixelSize(const Camera& camera) {
  const double along_x = 1.0 / (camera.fx * camera.fx), along_y = 1.0 / (camera.fy * camera.fy);
  const double excess = 0.5 * (along_x - along_y);
  return {0.5 * (along_x + along_y), {excess, -excess, 0.0}};
}

// The components of a displacement along and across the epipolar line of a direction.
struct Parts {
  Eigen::Vector3d unit_along, unit_across;
  double sin, along, across;
  // Variances of the noise, rad^2: across the line, and along it given the residual across, of which `slope`
  // is part of the residual along.
  double noise_across, noise_along, slope;
};
Parts ComputeParts(const Eigen::Vector3d& direction, const Displacement& match) {
  const Eigen::Vector3d e = direction - direction.dot(match.a) * match.a;
  Parts parts;
  parts.sin = std::max(e.norm(), 1e-9);
  parts.unit_along = e / parts.sin;
  parts.unit_across = match.a.cross(parts.unit_along);
  parts.along = parts.unit_along.dot(match.d);
  parts.across = parts.unit_across.dot(match.d);
  const Eigen::Vector3d excess = match.noise_excess * parts.unit_across;
  parts.noise_across = match.noise_variance + parts.unit_across.dot(excess);
  parts.slope = parts.unit_along.dot(excess) / parts.noise_across;
  parts.noise_along = match.noise_variance + parts.unit_along.dot(match.noise_excess * parts.unit_along) -
                      parts.slope * parts.slope * parts.noise_across;
  return parts;
}

// The logarithm of a product of factors >= 1. It needs few calls of log.
class LogProduct {
 public:
  void MultiplyBy(double factor) {
    product_ *= factor;
    if (product_ < 1e100) return;
    log_ += std::log(product_);
    product_ = 1.0;
  }
  double Log() const { return log_ + std::log(product_); }

 private:
  double log_ = 0.0, product_ = 1.0;
};

// First values: a plane across the mean ray at the median, and v from the median absolute deviation.
AxisFit FirstFit(const DisplacementSet& set, const std::vector<Parts>& parts) {
  AxisFit fit;
  fit.near = kFirstNear;
  if (parts.empty()) return fit;
  std::vector<double> values;
  for (const Parts& p : parts) values.push_back(p.along / p.sin);
  const double median = ValueOfRank(values.size() / 2, &values);
  fit.x.tail<3>() = median * set.mean_ray;
  for (double& value : values) value = std::abs(value - median);
  fit.variance = std::pow(1.4826 * ValueOfRank(values.size() / 2, &values), 2);
  return fit;
}

// A displacement under a fit: its residual along the line, and three densities, which sum to that of the
// mixture: the match is an inlier with an inverse depth of the common law (far), an inlier of any depth
// (near), or an outlier (wrong).
struct Rest {
  double along, along_variance, far, near, wrong;
  double All() const { return far + near + wrong; }
};
Rest ComputeRest(const DisplacementSet& set, const Parts& p, const Displacement& match, const AxisFit& fit) {
  Rest rest;
  const double across = p.across + fit.x.head<3>().dot(p.unit_along);
  rest.along =
      p.along - fit.x.head<3>().dot(p.unit_across) - fit.x.tail<3>().dot(match.a) * p.sin - p.slope * across;
  rest.along_variance = p.noise_along + fit.variance * p.sin * p.sin;
  const double law_across =
      std::exp(-0.5 * across * across / p.noise_across) / (kRootTwoPi * std::sqrt(p.noise_across));
  const double law_along = std::exp(-0.5 * rest.along * rest.along / rest.along_variance) /
                           (kRootTwoPi * std::sqrt(rest.along_variance));
  rest.far = (1.0 - kShareWrong - fit.near) * law_across * law_along;
  rest.near = fit.near * law_across / set.image_rad;
  rest.wrong = kShareWrong / (kBand * std::sqrt(match.noise_variance) * set.image_rad);
  return rest;
}

// The prior of n, the same for all directions in terms of the parallax n sin. Across the mean ray n sin is
// normal with the standard deviation size_rad: per radian of the image, the parallax may vary by the size of
// the displacements. Along the mean ray n sin is uniform.
struct PlanePrior {
  Eigen::Matrix3d precision;
  double log_density;
};
PlanePrior MakePlanePrior(const DisplacementSet& set, const std::vector<Parts>& parts) {
  double squares = 0.0;
  for (const Parts& p : parts) squares += p.sin * p.sin;
  const double sin2 = squares / static_cast<double>(parts.size());
  const double precision = sin2 / (set.size_rad * set.size_rad);
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - set.mean_ray * set.mean_ray.transpose();
  return {precision * across, std::log(precision) + 0.5 * std::log(sin2)};
}

// Sets the inverse depths of the plane; `covariance` is that of n.
void SetPlaneDepths(const DisplacementSet& set, const Eigen::Matrix3d& covariance, AxisFit* fit) {
  const auto in_sd = [&](const Eigen::Vector3d& ray) {
    return fit->x.tail<3>().dot(ray) / std::sqrt(std::max(ray.dot(covariance * ray), 1e-300));
  };
  fit->mean = in_sd(set.mean_ray);
  fit->least = std::numeric_limits<double>::infinity();
  fit->greatest = -fit->least;
  for (const Displacement& match : set.matches) {
    const double depth = in_sd(match.a);
    fit->least = std::min(fit->least, depth);
    fit->greatest = std::max(fit->greatest, depth);
  }
}

// One step of expectation-maximisation.
AxisFit Step(const DisplacementSet& set, const std::vector<Parts>& parts, const PlanePrior& plane,
             const AxisFit& old) {
  AxisFit fit;
  fit.direction = old.direction;
  Matrix6d information = Matrix6d::Zero();
  Vector6d moment = Vector6d::Zero();
  LogProduct likelihood;
  double squares = 0.0, fourths = 0.0, sum_near = 0.0;
  for (size_t i = 0; i < parts.size(); ++i) {
    const Parts& p = parts[i];
    const double sin2 = p.sin * p.sin;
    const Eigen::Vector3d& a = set.matches[i].a;
    const Rest rest = ComputeRest(set, p, set.matches[i], old);
    const double all = rest.All(), far = rest.far / all, near = rest.near / all;
    likelihood.MultiplyBy(all / rest.wrong);
    sum_near += near;
    Vector6d by_across, by_along;
    by_across << -p.unit_along, Eigen::Vector3d::Zero();
    by_along << p.unit_across, p.sin * a;
    by_along -= p.slope * by_across;
    const double w_across = (far + near) / p.noise_across, w_along = far / rest.along_variance;
    information += w_across * by_across * by_across.transpose() + w_along * by_along * by_along.transpose();
    moment += w_across * p.across * by_across + w_along * (p.along - p.slope * p.across) * by_along;
    const double share = far * sin2 / (rest.along_variance * rest.along_variance);
    squares += share * (rest.along * rest.along - p.noise_along);
    fourths += share * sin2;
  }
  // Priors are divided by all_over_used, which multiplies the sums over the matches below.
  information.bottomRightCorner<3, 3>() += plane.precision / set.all_over_used;
  const Eigen::Vector3d n = old.x.tail<3>();
  double prior_cost = 0.5 * n.dot(plane.precision * n) - plane.log_density;
  if (set.of_rotation) {
    const auto J = set.of_rotation->jacobian.leftCols<3>();
    const auto& r = set.of_rotation->residual;
    const Eigen::Matrix3d squares_of_J = J.transpose() * J;
    information.topLeftCorner<3, 3>() += squares_of_J / set.all_over_used;
    moment.head<3>() -= J.transpose() * r / set.all_over_used;
    prior_cost += 0.5 * (r + J * old.x.head<3>()).squaredNorm();
  }
  const Eigen::LDLT<Matrix6d> ldlt(information);
  fit.x = ldlt.solve(moment);
  if (!fit.x.allFinite()) return {};
  fit.variance = fourths > 0.0 ? std::max(squares / fourths, 0.0) : 0.0;
  fit.near = std::clamp(sum_near / static_cast<double>(parts.size()), kLeastNear, 1.0 - 2.0 * kShareWrong);
  const double log_det = ldlt.vectorD().array().max(1e-300).log().sum();
  fit.log_likelihood = set.all_over_used * likelihood.Log() - prior_cost - 0.5 * log_det;
  const Matrix6d covariance = ldlt.solve(Matrix6d::Identity()) / set.all_over_used;
  SetPlaneDepths(set, covariance.bottomRightCorner<3, 3>(), &fit);
  fit.information = information;
  return fit;
}

}  // namespace

DisplacementSet CollectDisplacements(const MotionProblem& problem, const ExplainedMode& mode) {
  const MixtureParameters& m = mode.mode.mixture;
  DisplacementSet set;
  const double sigma_px = problem.sigma_px * m.scale / m.noise.scale_of_gaussian;
  const PixelSize size1 = ComputePixelSize(problem.camera1), size2 = ComputePixelSize(problem.camera2);
  const double noise_variance = sigma_px * sigma_px * (size1.mean + size2.mean);
  const Eigen::Matrix3d& R = mode.mode.pose.R;
  const Eigen::Matrix3d noise_excess =
      sigma_px * sigma_px *
      (R * size1.excess.asDiagonal() * R.transpose() + Eigen::Matrix3d(size2.excess.asDiagonal()));
  for (size_t i = 0; i < problem.matches.size() && set.matches.size() < kMostMatches; ++i) {
    const Explanation& e = mode.explanation;
    if (e.probability[i] < 0.5) continue;
    const Eigen::Vector3d a = mode.mode.pose.R * problem.camera1.Ray(problem.matches[i].x1_px).normalized();
    const Eigen::Vector3d b = problem.camera2.Ray(problem.matches[i].x2_px).normalized();
    const double weight = std::min(NoiseWeight(m.noise, e.terms.residual[i] / m.scale), 1.0);
    const double w = NoiseScaleAt(problem, i);
    const double factor = w * w / (weight * e.probability[i]);
    set.matches.push_back({i, a, b - a.dot(b) * a, factor * noise_variance, factor * noise_excess});
  }
  const auto used = static_cast<double>(set.matches.size());
  set.all_over_used = std::max(mode.explanation.num_explained / std::max(used, 1.0), 1.0);
  Eigen::Vector3d sum_of_rays = Eigen::Vector3d::Zero();
  double squares = 0.0;
  for (const Displacement& match : set.matches) sum_of_rays += match.a, squares += match.d.squaredNorm();
  if (used > 0.0) {
    set.mean_ray = sum_of_rays.normalized();
    set.size_rad = std::max(std::sqrt(squares / used), 1e-9);
  }
  const Camera& camera2 = problem.camera2;
  set.image_rad = std::sqrt(camera2.width * camera2.height / (camera2.fx * camera2.fy));
  AddPrior(problem, mode.mode.pose, &set);
  return set;
}

AxisFit FitAxis(const DisplacementSet& set, const Eigen::Vector3d& direction) {
  std::vector<Parts> parts;
  parts.reserve(set.matches.size());
  for (const Displacement& match : set.matches) parts.push_back(ComputeParts(direction, match));
  AxisFit fit = FirstFit(set, parts);
  fit.direction = direction;
  const PlanePrior plane = MakePlanePrior(set, parts);
  for (int step = 0; step < kSteps; ++step) fit = Step(set, parts, plane, fit);
  return fit;
}

bool IsOutlier(const DisplacementSet& set, const Displacement& match, const AxisFit& fit) {
  const Rest rest = ComputeRest(set, ComputeParts(fit.direction, match), match, fit);
  return rest.far + rest.near <= rest.wrong;
}

}  // namespace rcme
