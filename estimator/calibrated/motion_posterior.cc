#include "estimator/calibrated/motion_posterior.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "stats/distributions.h"

namespace rcme {
namespace {

// Number of directions for the most likely component of the answer, and for that of the rivals. Other
// components get fewer, in proportion to their weight.
constexpr size_t kDirections = 512, kDirectionsOfRival = 128, kLeastDirections = 16;
constexpr size_t kPointsOfCells = 6000, kLeastOfCell = 4;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Probabilities that divide the law of the radius; there is a point at the median of each part.
constexpr std::array kRadiusLevels = {0.0,  0.05, 0.15, 0.25,  0.35, 0.45,  0.55,  0.65,   0.75,
                                      0.85, 0.9,  0.95, 0.975, 0.99, 0.997, 0.999, 0.9999, 1.0};
constexpr size_t kRadii = kRadiusLevels.size() - 1;

struct RadiusPoint {
  double radius, weight;
};
std::array<RadiusPoint, kRadii> MakeRadii() {
  std::array<RadiusPoint, kRadii> radii{};
  for (size_t k = 0; k < kRadii; ++k) {
    const double middle = 0.5 * (kRadiusLevels[k] + kRadiusLevels[k + 1]);
    radii[k] = {std::sqrt(ChiSquareQuantile(5, middle)), kRadiusLevels[k + 1] - kRadiusLevels[k]};
  }
  return radii;
}

// Evenly spread normal vectors, from an additive recurrence. Its steps are powers of the root of
// x^(d + 1) = x + 1 (the generalised golden ratio), d the dimension.
template <int kSize, size_t kNumber>
std::array<Eigen::Matrix<double, kSize, 1>, kNumber> MakeNormals() {
  double ratio = 2.0;
  for (int k = 0; k < 60; ++k) ratio = std::pow(1.0 + ratio, 1.0 / (kSize + 1.0));
  std::array<Eigen::Matrix<double, kSize, 1>, kNumber> normals;
  for (size_t i = 0; i < kNumber; ++i) {
    for (int k = 0; k < kSize; ++k) {
      const double at = 0.5 + static_cast<double>(i + 1) * std::pow(ratio, -(k + 1));
      normals[i](k) = NormalQuantile(at - std::floor(at));
    }
  }
  return normals;
}

template <int kSize>
Eigen::Matrix<double, kSize, kSize> ComputeRoot(const Eigen::Matrix<double, kSize, kSize>& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, kSize, kSize>> eigen(covariance);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

struct PosePoint {
  RelativePose pose;
  double weight;
  bool is_answer;
  bool is_in_cell = false;
};

// `share`: its weight relative to the greatest weight of the answer's components, or of the rivals.
void AddPoints(const MotionComponent& component, double share, std::vector<PosePoint>* points) {
  static const auto normals = MakeNormals<5, kDirections>();
  static const std::array<RadiusPoint, kRadii> radii = MakeRadii();
  const size_t most = component.is_answer ? kDirections : kDirectionsOfRival;
  const size_t number = std::max(static_cast<size_t>(share * static_cast<double>(most)), kLeastDirections);
  const Matrix5d root = ComputeRoot<5>(component.covariance);
  for (size_t i = 0; i < number; ++i) {
    const Vector5d unit = root * normals[i].normalized();
    for (const RadiusPoint& at : radii)
      points->push_back({Retract(component.mean, at.radius * unit),
                         component.weight * at.weight / static_cast<double>(number), component.is_answer});
  }
}

// The direction in the cell that has the share `area` of the cell's area nearer to the centre and the share
// `azimuth` of its azimuths below it.
Eigen::Vector3d DirectionIn(const DirectionCell& cell, const Eigen::Vector3d& centre, double area,
                            double azimuth) {
  const Eigen::Vector3d u = centre.unitOrthogonal(), v = centre.cross(u);
  const double cosine = (1.0 - area) * std::cos(cell.angle_low) + area * std::cos(cell.angle_high);
  const double sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
  const double turn = (1.0 - azimuth) * cell.azimuth_low + azimuth * cell.azimuth_high;
  return (cosine * centre + sine * (std::cos(turn) * u + std::sin(turn) * v)).normalized();
}

// A motion of the cell. `place` holds independent normal numbers: for the area, the azimuth and the rotation.
RelativePose MotionIn(const DirectionCell& cell, const Eigen::Matrix3d& root_of_rotation_cov,
                      const RelativePose& answer, const Vector5d& place) {
  const Eigen::Vector3d turn = cell.rotation + root_of_rotation_cov * place.tail<3>();
  return {RotationFromVector(turn) * answer.R,
          DirectionIn(cell, answer.t, NormalCdf(place(0)), NormalCdf(place(1)))};
}

// `share`: its weight relative to that of all cells.
void AddPoints(const MotionPosterior& posterior, const DirectionCell& cell, double share,
               std::vector<PosePoint>* points) {
  static const auto places = MakeNormals<5, kPointsOfCells + kLeastOfCell>();
  const Eigen::Matrix3d root = ComputeRoot<3>(cell.rotation_cov);
  const auto number = kLeastOfCell + static_cast<size_t>(share * static_cast<double>(kPointsOfCells));
  for (size_t k = 0; k < number; ++k)
    points->push_back({MotionIn(cell, root, posterior.answer, places[k]),
                       cell.weight / static_cast<double>(number), true, true});
}

// The number of points of a component or cell depends on its share alone, not on its absolute weight.
std::vector<PosePoint> MakePosePoints(const MotionPosterior& posterior) {
  std::vector<PosePoint> points;
  double greatest[2] = {0.0, 0.0}, of_cells = 0.0;
  for (const MotionComponent& component : posterior.components)
    greatest[component.is_answer] = std::max(greatest[component.is_answer], component.weight);
  for (const DirectionCell& cell : posterior.cells) of_cells += cell.weight;
  for (const MotionComponent& component : posterior.components) {
    const double most = greatest[component.is_answer];
    if (most > 0.0) AddPoints(component, std::min(component.weight / most, 1.0), &points);
  }
  for (const DirectionCell& cell : posterior.cells)
    if (of_cells > 0.0) AddPoints(posterior, cell, std::min(cell.weight / of_cells, 1.0), &points);
  return points;
}

bool IsBeyond(const MotionDistance& distance, const MotionBounds& bounds) {
  return distance.rotation_rad > bounds.rotation_rad || distance.direction_rad > bounds.direction_rad;
}

void ScaleWeights(double factor, bool is_answer, MotionPosterior* posterior) {
  for (MotionComponent& component : posterior->components)
    if (component.is_answer == is_answer) component.weight *= factor;
  if (is_answer)
    for (DirectionCell& cell : posterior->cells) cell.weight *= factor;
}

double SumWeight(bool is_answer, const MotionPosterior& posterior) {
  double weight = 0.0;
  for (const MotionComponent& component : posterior.components)
    if (component.is_answer == is_answer) weight += component.weight;
  if (is_answer)
    for (const DirectionCell& cell : posterior.cells) weight += cell.weight;
  return weight;
}

// Narrows the answer by `factor` and scales its weights to a sum of one.
MotionPosterior Narrowed(MotionPosterior posterior, double factor, const MotionBounds& bounds) {
  posterior.narrowed = factor;
  for (MotionComponent& component : posterior.components)
    if (component.is_answer) component.covariance *= factor * factor;
  for (DirectionCell& cell : posterior.cells) {
    if (cell.angle_low >= bounds.direction_rad * (1.0 - 1e-9)) cell.weight *= factor;
    cell.rotation *= factor;
    cell.rotation_cov *= factor * factor;
  }
  const double weight = SumWeight(true, posterior);
  if (weight > 0.0) ScaleWeights(1.0 / weight, true, &posterior);
  return posterior;
}

double BeyondOfAnswer(MotionPosterior posterior, const MotionBounds& bounds) {
  std::erase_if(posterior.components, [](const MotionComponent& component) { return !component.is_answer; });
  return PosteriorDistances(posterior, posterior.answer).ComputeBeyond(true, bounds);
}

// The widest posterior whose answer has no more than the mass `most` beyond the bounds.
MotionPosterior NarrowedTo(double most, const MotionPosterior& posterior, const MotionBounds& bounds) {
  constexpr int kHalvings = 12;
  MotionPosterior within = Narrowed(posterior, 1.0, bounds);
  if (BeyondOfAnswer(within, bounds) <= most) return within;
  double low = 0.0, high = 1.0;
  within = Narrowed(posterior, 0.0, bounds);
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    MotionPosterior tried = Narrowed(posterior, middle, bounds);
    const bool is_within = BeyondOfAnswer(tried, bounds) <= most;
    (is_within ? low : high) = middle;
    if (is_within) within = std::move(tried);
  }
  return within;
}

// A step of Weiszfeld's iteration: the mean of `steps`, which lead to the points, weighted by weight over
// length.
template <typename Steps>
auto MedianStep(const Steps& steps, const std::vector<PosePoint>& points) {
  typename Steps::value_type sum = Steps::value_type::Zero();
  double total = 0.0;
  for (size_t i = 0; i < points.size(); ++i) {
    const double by_length = points[i].weight / std::max(steps[i].norm(), 1e-9);
    sum += by_length * steps[i];
    total += by_length;
  }
  return total > 0.0 ? (sum / total).eval() : sum;
}

}  // namespace

MotionPosterior MakeMotionPosterior(const RelativePose& answer, const MotionBounds& bounds,
                                    double failure_probability, std::vector<MotionComponent> components,
                                    std::vector<DirectionCell> cells) {
  MotionPosterior posterior{answer, std::move(components), std::move(cells), 0.0, 1.0};
  const double p = failure_probability;
  double of_rivals = SumWeight(false, posterior);
  double beyond = PosteriorDistances(posterior, answer).ComputeBeyond(false, bounds);
  const double within = of_rivals - beyond;
  const double kept =
      std::min({1.0, beyond > 0.0 ? p / beyond : 1.0, within > 0.0 ? (1.0 - p) / within : 1.0});
  ScaleWeights(kept, false, &posterior);
  of_rivals *= kept;
  beyond *= kept;
  const double most = of_rivals < 1.0 ? std::max(p - beyond, 0.0) / (1.0 - of_rivals) : 0.0;
  posterior = NarrowedTo(most, posterior, bounds);
  const double of_answer = (1.0 - p - (of_rivals - beyond)) / (1.0 - BeyondOfAnswer(posterior, bounds));
  ScaleWeights(std::clamp(of_answer, 0.0, 1.0 - of_rivals), true, &posterior);
  posterior.weight_of_none = std::max(1.0 - SumWeight(false, posterior) - SumWeight(true, posterior), 0.0);
  return posterior;
}

PosteriorDistances::PosteriorDistances(const MotionPosterior& posterior, const RelativePose& motion)
    : weight_of_none_(posterior.weight_of_none) {
  for (const PosePoint& point : MakePosePoints(posterior))
    points_.push_back({{RotationAngleBetween(motion.R, point.pose.R), AngleBetween(motion.t, point.pose.t)},
                       point.weight,
                       point.is_answer});
}

double PosteriorDistances::ComputeBeyond(bool is_answer, const MotionBounds& bounds) const {
  double sum = 0.0;
  for (const Point& point : points_)
    if (point.is_answer == is_answer && IsBeyond(point.distance, bounds)) sum += point.weight;
  return sum;
}

double PosteriorDistances::FailureProbability(const MotionBounds& bounds) const {
  return std::min(weight_of_none_ + ComputeBeyond(true, bounds) + ComputeBeyond(false, bounds), 1.0);
}

template <typename Value>
double PosteriorDistances::Quantile(double level, Value value) const {
  std::vector<std::pair<double, double>> sorted;
  for (const Point& point : points_) sorted.emplace_back(value(point.distance), point.weight);
  std::ranges::sort(sorted);
  double sum = 0.0;
  for (const auto& [x, weight] : sorted) {
    sum += weight;
    if (sum >= level) return x;
  }
  return kInfinity;
}

MotionDistance PosteriorDistances::FindQuantile(double level) const {
  return {Quantile(level, [](const MotionDistance& d) { return d.rotation_rad; }),
          Quantile(level, [](const MotionDistance& d) { return d.direction_rad; })};
}

MotionBounds PosteriorDistances::RegionAt(double level, const MotionBounds& shape) const {
  const double factor = Quantile(level, [&](const MotionDistance& d) {
    return std::max(d.rotation_rad / shape.rotation_rad, d.direction_rad / shape.direction_rad);
  });
  return {factor * shape.rotation_rad, factor * shape.direction_rad};
}

double FailureProbability(const MotionPosterior& posterior, const RelativePose& answer,
                          const MotionBounds& bounds) {
  return PosteriorDistances(posterior, answer).FailureProbability(bounds);
}

PosteriorCovariance Covariance(const MotionPosterior& posterior) {
  PosteriorCovariance covariance;
  Matrix5d of_rivals = Matrix5d::Zero();
  for (const MotionComponent& component : posterior.components) {
    if (!component.is_answer) continue;
    const Vector5d away = LocalCoordinates(posterior.answer, component.mean);
    const Matrix5d to_answer = TransportTangent(component.mean, posterior.answer);
    covariance.of_answer += component.weight * (to_answer * component.covariance * to_answer.transpose() +
                                                away * away.transpose());
  }
  for (const PosePoint& point : MakePosePoints(posterior)) {
    if (point.is_answer && !point.is_in_cell) continue;  // in closed form, above
    const Vector5d away = LocalCoordinates(posterior.answer, point.pose);
    (point.is_answer ? covariance.of_answer : of_rivals) += point.weight * away * away.transpose();
  }
  const double answer = SumWeight(true, posterior), rivals = SumWeight(false, posterior);
  if (answer + rivals > 0.0) covariance.total = (covariance.of_answer + of_rivals) / (answer + rivals);
  if (answer > 0.0) covariance.of_answer /= answer;
  return covariance;
}

RelativePose Median(const MotionPosterior& posterior) {
  constexpr int kMostSteps = 50;
  constexpr double kNegligible = 1e-6;  // rad
  const std::vector<PosePoint> points = MakePosePoints(posterior);
  RelativePose median = posterior.answer;
  std::vector<Eigen::Vector3d> rotations(points.size());
  std::vector<Eigen::Vector2d> directions(points.size());
  for (int step = 0; step < kMostSteps; ++step) {
    for (size_t i = 0; i < points.size(); ++i) {
      const Vector5d away = LocalCoordinates(median, points[i].pose);
      rotations[i] = away.head<3>();
      directions[i] = away.tail<2>();
    }
    Vector5d move;
    move << MedianStep(rotations, points), MedianStep(directions, points);
    median = Retract(median, move);
    if (move.norm() < kNegligible) break;
  }
  return median;
}

std::optional<RelativePose> Draw(const MotionPosterior& posterior, RandomStream& rng) {
  double left = rng.Uniform();
  for (const MotionComponent& component : posterior.components) {
    left -= component.weight;
    if (left >= 0.0) continue;
    Vector5d normal;
    for (double& x : normal) x = rng.Normal();
    return Retract(component.mean, ComputeRoot<5>(component.covariance) * normal);
  }
  for (const DirectionCell& cell : posterior.cells) {
    left -= cell.weight;
    if (left >= 0.0) continue;
    Vector5d place;
    for (double& x : place) x = rng.Normal();
    return MotionIn(cell, ComputeRoot<3>(cell.rotation_cov), posterior.answer, place);
  }
  return std::nullopt;
}

}  // namespace rcme
