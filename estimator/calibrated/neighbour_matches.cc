#include "estimator/calibrated/neighbour_matches.h"

#include <algorithm>
#include <array>
#include <limits>

namespace rcme {
namespace {

constexpr size_t kMostNeighbours = 128;
constexpr double kApart = 0.5;          // of two displacements, relative to the distance
constexpr double kAlike = 3.0;          // standard deviations
constexpr double kLeastDistance = 1.0;  // px; nearer ones are the same key point

}  // namespace

std::vector<size_t> FindNearestNeighbours(const MotionProblem& problem, const std::vector<size_t>& some,
                                          double least_px) {
  const size_t n = std::min(some.size(), kMostNeighbours);
  const double least = least_px * least_px;
  std::array<Correspondence, kMostNeighbours> matches;
  std::array<double, kMostNeighbours> square{};
  std::vector<size_t> nearest(n);
  for (size_t a = 0; a < n; ++a) {
    matches[a] = problem.matches[some[a]];
    square[a] = std::numeric_limits<double>::infinity();
    nearest[a] = a;
    for (size_t b = 0; b < a; ++b) {
      const double away = (matches[a].x1_px - matches[b].x1_px).squaredNorm();
      if (away >= square[a] && away >= square[b]) continue;
      if (away < least || (matches[a].x2_px - matches[b].x2_px).squaredNorm() < least) continue;
      if (away < square[a]) square[a] = away, nearest[a] = b;
      if (away < square[b]) square[b] = away, nearest[b] = a;
    }
  }
  return nearest;
}

double ComputeCoherence(const MotionProblem& problem, const std::vector<size_t>& some) {
  const std::vector<size_t> nearest = FindNearestNeighbours(problem, some, kLeastDistance);
  double together = 0.0, count = 0.0;
  for (size_t a = 0; a < nearest.size(); ++a) {
    if (nearest[a] == a) continue;
    const Correspondence &match = problem.matches[some[a]], &other = problem.matches[some[nearest[a]]];
    const Eigen::Vector2d from = other.x1_px - match.x1_px, to = other.x2_px - match.x2_px;
    together += (to - from).norm() < kApart * from.norm() + kAlike * problem.sigma_px;
    count += 1.0;
  }
  return count > 0.0 ? together / count : 0.0;
}

}  // namespace rcme
