#include "estimator/calibrated/direction_posterior.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "estimator/noise_scale.h"
#include "stats/order_statistic.h"

namespace rcme {
namespace {

constexpr size_t kMostMatches = 256;
// Axes about a centre: rings from 0 to 90 deg, with a border at the failure bound.
constexpr int kInnerRings = 4, kOuterRings = 6, kAzimuths = 10;
constexpr int kSteps = 3;
constexpr double kShareWrong = 0.02;                    // of the matches that the mode explains
constexpr double kFirstNear = 0.1, kLeastNear = 0.005;  // share of matches with a parallax of any size
constexpr double kBand = 6.0;  // half width, in standard deviations across, of the band of a mode's matches
constexpr double kRootTwoPi = 2.5066282746310002;

struct Displacement {
  size_t match;  // index of the match
  // unit ray of camera 1 in camera 2's frame; (b - a) projected onto the plane normal to a
  Eigen::Vector3d a, d;
  // Of this match, with its noise_scale, divided by the weight of its residual: s^2, and how much more the
  // variance is along a unit vector u, u' excess u (zero if the pixels are square). rad^2
  double noise_variance;
  Eigen::Matrix3d noise_excess;
};

struct DisplacementSet {
  std::vector<Displacement> matches;
  double all_over_used = 1.0;  // explained matches per match in `matches`
  double image_rad = 1.0;      // extent of image 2, over which the displacement of an outlier is uniform
  Eigen::Vector3d mean_ray = Eigen::Vector3d::UnitZ();  // unit
  double size_rad = 1.0;                                // root mean square of |d|
  // The prior of w, if there is one: cost |r + J w|^2 / 2, with r and J at the mode's rotation. And the prior
  // of the direction.
  std::optional<PriorResiduals> of_rotation = {};
  std::optional<DirectionPrior> of_direction = {};
};

// Adds the problem's prior: the direction by itself, all else linearised at the mode's rotation.
void AddPrior(const MotionProblem& problem, const RelativePose& pose, DisplacementSet* set) {
  if (!problem.prior) return;
  MotionPrior prior = *problem.prior;
  set->of_direction = prior.direction;
  prior.direction.reset();
  if (CountPriorFreedom(prior) > 0) set->of_rotation = ComputePriorResiduals(prior, pose);
}

// The prior density of a direction, relative to its maximum.
double PriorDensity(const Eigen::Vector3d& direction, const DisplacementSet& set) {
  const double away = AngleBetween(direction, set.of_direction->t) / set.of_direction->sd_rad;
  return std::exp(-0.5 * away * away);
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

DisplacementSet Displacements(const MotionProblem& problem, const ExplainedMode& mode) {
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
  set.image_rad = std::sqrt(problem.camera2.width * problem.camera2.height * size2.mean);
  AddPrior(problem, mode.mode.pose, &set);
  return set;
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

double UpperQuantile(double share, std::vector<double>* values) {
  if (values->empty()) return 0.0;
  return ValueOfRank(static_cast<size_t>(share * static_cast<double>(values->size())), values);
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

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

struct AxisFit {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  Vector6d x = Vector6d::Zero();  // w, n: the inverse depth of a ray a is n'a
  double variance = 0.0;          // v
  double near = kFirstNear;
  double log_likelihood = -std::numeric_limits<double>::infinity();
  // The inverse depth of the plane n, in standard deviations: at the mean ray, and the extremes over the
  // matches.
  double mean = 0.0, least = 0.0, greatest = 0.0;
  Matrix6d information = Matrix6d::Zero();  // of x, from the matches in the set
};

// First values: a plane across the mean ray at the median, and v from the median absolute deviation.
AxisFit FirstFit(const DisplacementSet& set, const std::vector<Parts>& parts) {
  AxisFit fit;
  std::vector<double> values;
  for (const Parts& p : parts) values.push_back(p.along / p.sin);
  const double median = UpperQuantile(0.5, &values);
  fit.x.tail<3>() = median * set.mean_ray;
  for (double& value : values) value = std::abs(value - median);
  fit.variance = std::pow(1.4826 * UpperQuantile(0.5, &values), 2);
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
    information.topLeftCorner<3, 3>() += J.transpose() * J / set.all_over_used;
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

// Fits the model of the header at one direction.
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

double NormalCdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

// The weight of an axis for its direction (ahead) and the opposite one (behind), and their sum.
struct TwoWays {
  double ahead, behind, both;
};
TwoWays DivideWeight(double weight, const AxisFit& fit, const DisplacementSet& set) {
  // Where no direction has the whole plane in front, the mean inverse depth decides.
  constexpr double kPartlyBehind = 1e-6;
  const double ahead = (NormalCdf(fit.least) + kPartlyBehind * NormalCdf(fit.mean)) * weight;
  const double behind = (NormalCdf(-fit.greatest) + kPartlyBehind * NormalCdf(-fit.mean)) * weight;
  if (!set.of_direction) return {ahead, behind, ahead + behind};
  const double a = ahead * PriorDensity(fit.direction, set), b = behind * PriorDensity(-fit.direction, set);
  return {a, b, a + b};
}

struct WeightedAxis {
  double angle;               // from the centre to the axis, rad, at most pi / 2
  double low, high, azimuth;  // its cell of the sphere, rad
  double log_area;            // log of the cell's area, up to a constant
  AxisFit fit;
};

std::vector<WeightedAxis> FitAxes(const DisplacementSet& set, const Eigen::Vector3d& centre, double edge) {
  const Eigen::Vector3d u = centre.unitOrthogonal(), v = centre.cross(u);
  std::vector<WeightedAxis> axes;
  const auto add_rings = [&](double from, double to, int count) {
    for (int ring = 0; ring < count; ++ring) {
      const double low = from + (to - from) * ring / count, high = from + (to - from) * (ring + 1) / count;
      const double angle = 0.5 * (low + high);
      for (int k = 0; k < kAzimuths; ++k) {
        const double azimuth = 2.0 * std::numbers::pi * (k + 0.5 * (ring % 2)) / kAzimuths;
        const Eigen::Vector3d direction =
            std::cos(angle) * centre + std::sin(angle) * (std::cos(azimuth) * u + std::sin(azimuth) * v);
        axes.push_back(
            {angle, low, high, azimuth, std::log(std::cos(low) - std::cos(high)), FitAxis(set, direction)});
      }
    }
  };
  add_rings(0.0, edge, kInnerRings);
  add_rings(edge, 0.5 * std::numbers::pi, kOuterRings);
  return axes;
}

// The border between the inner and the outer rings: at the angle, or at its supplement, which is the same
// border about the opposite direction.
double EdgeAt(double angle_rad) {
  constexpr double kHalfPi = 0.5 * std::numbers::pi;
  const double edge = angle_rad < kHalfPi ? angle_rad : std::max(std::numbers::pi - angle_rad, 1e-3);
  return std::min(edge, kHalfPi - 1e-3);
}

const WeightedAxis& MostLikely(const std::vector<WeightedAxis>& axes) {
  return *std::ranges::max_element(axes, {}, [](const WeightedAxis& a) { return a.fit.log_likelihood; });
}

// The weight of the axes, relative to that with the log-likelihood `greatest`, within an angle of either
// direction.
double SumWeightNear(const Eigen::Vector3d& one, const Eigen::Vector3d& other, double angle_rad,
                     const std::vector<WeightedAxis>& axes, double greatest, const DisplacementSet& set) {
  double sum = 0.0;
  for (const WeightedAxis& axis : axes) {
    const double weight = std::exp(axis.fit.log_likelihood - greatest + axis.log_area);
    const TwoWays ways = DivideWeight(weight, axis.fit, set);
    const double from_one = AngleBetween(axis.fit.direction, one), kPi = std::numbers::pi;
    const double from_other = AngleBetween(axis.fit.direction, other);
    if (std::min(from_one, from_other) <= angle_rad) sum += ways.ahead;
    if (kPi - std::max(from_one, from_other) <= angle_rad) sum += ways.behind;
  }
  return sum;
}

// The second moment about the centre of the motions whose direction lies in the cell of an axis.
Matrix5d ComputeSecondMoment(const WeightedAxis& axis, const RelativePose& centre, double all_over_used) {
  const Vector5d away =
      LocalCoordinates(centre, {RotationFromVector(axis.fit.x.head<3>()) * centre.R, axis.fit.direction});
  Matrix5d moment = away * away.transpose();
  moment.topLeftCorner<3, 3>() += (axis.fit.information.inverse() / all_over_used).topLeftCorner<3, 3>();
  // The cell's own extent: a uniform law over an interval has a twelfth of its squared length.
  const double width = axis.high - axis.low, length = axis.angle * 2.0 * std::numbers::pi / kAzimuths;
  const Eigen::Vector2d outward = away.tail<2>().normalized();
  moment.bottomRightCorner<2, 2>() +=
      (width * width * outward * outward.transpose() +
       length * length * (Eigen::Matrix2d::Identity() - outward * outward.transpose())) /
      12.0;
  return moment;
}

}  // namespace

std::vector<DirectionCell> ComputeDirectionCells(const MotionProblem& problem, const ExplainedMode& mode,
                                                 double angle_rad) {
  constexpr double kPi = std::numbers::pi;
  const DisplacementSet set = Displacements(problem, mode);
  const std::vector<WeightedAxis> axes = FitAxes(set, mode.mode.pose.t, EdgeAt(angle_rad));
  const double greatest = MostLikely(axes).fit.log_likelihood;
  std::vector<DirectionCell> cells;
  double total = 0.0;
  for (const WeightedAxis& axis : axes) {
    const double weight = std::exp(axis.fit.log_likelihood - greatest + axis.log_area);
    if (!(weight > 0.0)) continue;
    const Matrix6d covariance = axis.fit.information.inverse() / set.all_over_used;
    const TwoWays ways = DivideWeight(weight, axis.fit, set);
    const double half = kPi / kAzimuths;
    const Eigen::Vector3d rotation = axis.fit.x.head<3>();
    const Eigen::Matrix3d rotation_cov = covariance.topLeftCorner<3, 3>();
    cells.push_back(
        {axis.low, axis.high, axis.azimuth - half, axis.azimuth + half, ways.ahead, rotation, rotation_cov});
    cells.push_back({kPi - axis.high, kPi - axis.low, axis.azimuth + kPi - half, axis.azimuth + kPi + half,
                     ways.behind, rotation, rotation_cov});
    total += ways.both;
  }
  for (DirectionCell& cell : cells) cell.weight /= total;
  return cells;
}

double UsualDepthInNoise(const Explanation& explanation) {
  std::vector<double> depths;
  for (size_t i = 0; i < explanation.probability.size(); ++i) {
    if (explanation.probability[i] > 0.5) depths.push_back(explanation.terms.depth[i]);
  }
  return UpperQuantile(0.8, &depths);
}

DirectionPosterior PosteriorOfDirection(const MotionProblem& problem, const ExplainedMode& mode,
                                        const Eigen::Vector3d& centre, double angle_rad) {
  const DisplacementSet set = Displacements(problem, mode);
  const std::vector<WeightedAxis> axes = FitAxes(set, centre, EdgeAt(angle_rad));
  const AxisFit& greatest = MostLikely(axes).fit;
  AxisFit best = greatest;
  bool is_behind = best.mean < 0.0;
  double within = 0.0, total = 0.0, most = 0.0, ahead = 0.0;
  Matrix5d moment = Matrix5d::Zero();
  for (const WeightedAxis& axis : axes) {
    const double density = std::exp(axis.fit.log_likelihood - greatest.log_likelihood);
    const double weight = std::exp(axis.fit.log_likelihood - greatest.log_likelihood + axis.log_area);
    const TwoWays ways = DivideWeight(weight, axis.fit, set);
    total += ways.both;
    ahead += ways.ahead;
    if (ways.ahead > 0.0)
      moment += ways.ahead * ComputeSecondMoment(axis, {mode.mode.pose.R, centre}, set.all_over_used);
    if (axis.angle <= angle_rad) within += ways.ahead;
    if (std::numbers::pi - axis.angle <= angle_rad) within += ways.behind;
    const TwoWays densities = DivideWeight(density, axis.fit, set);
    if (!(std::max(densities.ahead, densities.behind) > most)) continue;
    most = std::max(densities.ahead, densities.behind);
    best = axis.fit;
    is_behind = densities.behind > densities.ahead;
  }
  DirectionPosterior posterior;
  posterior.best = mode.mode;
  posterior.best.pose = {RotationFromVector(best.x.head<3>()) * mode.mode.pose.R,
                         is_behind ? Eigen::Vector3d(-best.direction) : best.direction};
  if (total > 0.0) {
    posterior.mass_within = within / total;
    posterior.mass_of_both =
        SumWeightNear(centre, posterior.best.pose.t, angle_rad, axes, greatest.log_likelihood, set) / total;
  }
  posterior.covariance = ahead > 0.0 ? Matrix5d(moment / ahead)
                                     : Matrix5d(std::numbers::pi * std::numbers::pi * Matrix5d::Identity());
  for (const Displacement& match : set.matches) {
    const Rest rest = ComputeRest(set, ComputeParts(best.direction, match), match, best);
    if (rest.far + rest.near > rest.wrong) continue;
    posterior.best.used[match.match / kBlockSize] &=
        static_cast<std::uint8_t>(~(1u << (match.match % kBlockSize)));
  }
  return posterior;
}

}  // namespace rcme
