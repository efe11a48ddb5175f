#include "stats/spatial_pattern.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stats/constants.h"

namespace rcme {
namespace {

bool IsLeftOf(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
}

// Twice the signed area of the triangle abc.
double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

}  // namespace

// Andrew's (1979) monotone chain: the lower hull from left to right, then the upper one back.
double ConvexHullArea(std::vector<Eigen::Vector2d> points) {
  if (points.size() < 3) return 0.0;
  std::ranges::sort(points, IsLeftOf);
  std::vector<Eigen::Vector2d> hull;
  for (int side = 0; side < 2; ++side) {
    const size_t first = hull.size();
    for (const Eigen::Vector2d& point : points) {
      while (hull.size() >= first + 2 && Cross(hull[hull.size() - 2], hull.back(), point) <= 0.0)
        hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();  // the first point of the other side
    std::ranges::reverse(points);
  }
  double twice_area = 0.0;
  for (size_t i = 2; i < hull.size(); ++i) twice_area += Cross(hull[0], hull[i - 1], hull[i]);
  return 0.5 * twice_area;
}

// Sweeps from left to right: the nearest point cannot lie farther to a side than the nearest found so far.
double MeanNearestNeighborDistance(std::vector<Eigen::Vector2d> points) {
  if (points.size() < 2) return kNaN;
  std::ranges::sort(points, IsLeftOf);
  double sum = 0.0;
  for (size_t i = 0; i < points.size(); ++i) {
    double nearest = std::numeric_limits<double>::infinity();  // squared
    const auto is_too_far = [&](size_t j) {
      const double dx = points[j].x() - points[i].x();
      if (dx * dx >= nearest) return true;
      nearest = std::min(nearest, (points[j] - points[i]).squaredNorm());
      return false;
    };
    for (size_t j = i + 1; j < points.size() && !is_too_far(j); ++j) {
    }
    for (size_t j = i; j > 0 && !is_too_far(j - 1); --j) {
    }
    sum += std::sqrt(nearest);
  }
  return sum / static_cast<double>(points.size());
}

double ClarkEvansIndex(const std::vector<Eigen::Vector2d>& points, double width, double height) {
  const double n = static_cast<double>(points.size());
  const double area = width * height, perimeter = 2.0 * (width + height);
  const double expected = 0.5 * std::sqrt(area / n) + (0.0514 + 0.041 / std::sqrt(n)) * perimeter / n;
  return MeanNearestNeighborDistance(points) / expected;
}

}  // namespace rcme
