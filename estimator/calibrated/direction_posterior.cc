#include "estimator/calibrated/direction_posterior.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimator/calibrated/direction_axis.h"
#include "stats/order_statistic.h"

namespace rcme {
namespace {

// Axes about a centre: rings from 0 to 90 deg, with a border at the failure bound.
constexpr int kInnerRings = 4, kOuterRings = 6, kAzimuths = 10;

// The prior density of a direction, relative to its maximum.
double PriorDensity(const Eigen::Vector3d& direction, const DisplacementSet& set) {
  const double away = AngleBetween(direction, set.of_direction->t) / set.of_direction->sd_rad;
  return std::exp(-0.5 * away * away);
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
  const Eigen::Matrix3d rotation_cov = axis.fit.information.inverse().topLeftCorner<3, 3>();
  moment.topLeftCorner<3, 3>() += rotation_cov / all_over_used;
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
  const DisplacementSet set = CollectDisplacements(problem, mode);
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
  return depths.empty() ? 0.0 : ValueOfRank(depths.size() * 4 / 5, &depths);
}

DirectionPosterior PosteriorOfDirection(const MotionProblem& problem, const ExplainedMode& mode,
                                        const Eigen::Vector3d& centre, double angle_rad) {
  const DisplacementSet set = CollectDisplacements(problem, mode);
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
    if (!IsOutlier(set, match, best)) continue;
    posterior.best.used[match.match / kBlockSize] &=
        static_cast<std::uint8_t>(~(1u << (match.match % kBlockSize)));
  }
  return posterior;
}

}  // namespace rcme
