#include "estimator/robust_covariance/clustered_covariance.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "estimator/noise_scale.h"
#include "estimator/refinement/sampson_equations.h"
#include "estimator/robust_covariance/disjoint_sets.h"

namespace rcme {
namespace {

// Points in a grid of square cells, whose width is the radius of search. Cells are found by hashing.
class PointGrid {
 public:
  PointGrid(size_t num_points, double radius)
      : radius_(radius), slots_(std::bit_ceil(2 * num_points + 1), kEmpty) {
    cells_.reserve(num_points);
  }

  // Calls visit(k) for the points k in the cell of x and in the eight cells around it, then adds x as point
  // i. Only the first 16 points of a cell are stored and visited, because more would take quadratic time.
  template <typename Visit>
  void VisitAndAdd(std::uint32_t i, const Eigen::Vector2d& x, const Visit& visit) {
    const Eigen::Vector2d cell = (x / radius_).array().floor();
    std::array<std::uint64_t, 3> hashes_x, hashes_y;
    for (size_t d = 0; d < 3; ++d) {
      hashes_x[d] = Hash(cell.x() + static_cast<double>(d) - 1.0, 0x9e3779b97f4a7c15);
      hashes_y[d] = Hash(cell.y() + static_cast<double>(d) - 1.0, 0xc2b2ae3d27d4eb4f);
    }
    for (size_t dx = 0; dx < 3; ++dx) {
      for (size_t dy = 0; dy < 3; ++dy) {
        const double cell_x = cell.x() + static_cast<double>(dx) - 1.0;
        const double cell_y = cell.y() + static_cast<double>(dy) - 1.0;
        const std::uint32_t found = slots_[FindSlot(hashes_x[dx] + hashes_y[dy], cell_x, cell_y)];
        if (found == kEmpty) continue;
        for (std::uint32_t k = 0; k < cells_[found].size; ++k) visit(cells_[found].points[k]);
      }
    }
    std::uint32_t& slot = slots_[FindSlot(hashes_x[1] + hashes_y[1], cell.x(), cell.y())];
    if (slot == kEmpty) {
      slot = static_cast<std::uint32_t>(cells_.size());
      cells_.push_back({cell.x(), cell.y(), 0, {}});
    }
    Cell& own = cells_[slot];
    if (own.size < own.points.size()) own.points[own.size++] = i;
  }

 private:
  static constexpr std::uint32_t kEmpty = 0xffffffff;
  struct Cell {
    double x, y;
    std::uint32_t size;
    std::array<std::uint32_t, 16> points;
  };

  static std::uint64_t Hash(double coordinate, std::uint64_t factor) {
    const auto bits = std::bit_cast<std::uint64_t>(coordinate + 0.0);  // -0 is 0
    return (bits ^ bits >> 32) * factor;
  }
  // The slot of the cell, or the empty slot where it belongs.
  size_t FindSlot(std::uint64_t hash, double x, double y) const {
    const size_t last = slots_.size() - 1;
    size_t slot = static_cast<size_t>(hash ^ hash >> 32) & last;
    while (slots_[slot] != kEmpty && !(cells_[slots_[slot]].x == x && cells_[slots_[slot]].y == y))
      slot = (slot + 1) & last;
    return slot;
  }

  double radius_;
  std::vector<std::uint32_t> slots_;  // indices of cells; at least half are empty
  std::vector<Cell> cells_;
};

// share of the information along a direction that is kept without a group
constexpr double kLeastKept = 0.05;

// Unites the matches whose points in one image are within the radius.
void UniteNeighbours(const std::vector<Correspondence>& matches, Eigen::Vector2d Correspondence::*x_px,
                     double radius_px, DisjointSets* groups) {
  PointGrid grid(matches.size(), radius_px);
  for (size_t i = 0; i < matches.size(); ++i) {
    const Eigen::Vector2d& x = matches[i].*x_px;
    grid.VisitAndAdd(static_cast<std::uint32_t>(i), x, [&](std::uint32_t k) {
      if ((matches[k].*x_px - x).norm() <= radius_px) groups->Unite(i, k);
    });
  }
}

// The indices of the matches by group, ascending within each group.
struct GroupMembers {
  explicit GroupMembers(std::span<const int> groups)
      : starts(groups.empty() ? 1 : static_cast<size_t>(*std::ranges::max_element(groups)) + 2, 0),
        members(groups.size()) {
    for (const int group : groups) ++starts[static_cast<size_t>(group) + 1];
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    std::vector<size_t> next = starts;
    for (size_t i = 0; i < groups.size(); ++i) members[next[static_cast<size_t>(groups[i])]++] = i;
  }
  size_t size() const { return starts.size() - 1; }
  std::span<const size_t> Of(size_t group) const {
    return std::span(members).subspan(starts[group], starts[group + 1] - starts[group]);
  }

  std::vector<size_t> starts, members;
};

// (1 - A_c)^-1 s_c of a group; the rows are in coordinates in which A is the identity.
Vector5d MoveWithout(std::span<const size_t> group, const std::vector<Vector5d>& rows,
                     const std::vector<double>& residuals) {
  if (group.size() == 1) {
    const Vector5d& row = rows[group[0]];
    return residuals[group[0]] / std::max(1.0 - row.squaredNorm(), kLeastKept) * row;
  }
  Vector5d score = Vector5d::Zero();
  Matrix5d information = Matrix5d::Zero();
  for (const size_t i : group) {
    score += residuals[i] * rows[i];
    information += rows[i] * rows[i].transpose();
  }
  // No eigenvalue exceeds the trace.
  if (information.trace() < 1.0 - kLeastKept)
    return Matrix5d(Matrix5d::Identity() - information).llt().solve(score);
  const Eigen::SelfAdjointEigenSolver<Matrix5d> eigen(information);
  const Vector5d kept = (1.0 - eigen.eigenvalues().array()).max(kLeastKept);
  return eigen.eigenvectors() * (eigen.eigenvectors().transpose() * score).cwiseQuotient(kept);
}

}  // namespace

MatchScores ScoreFitted(const MotionProblem& problem, std::span<const int> fitted, const RelativePose& pose) {
  const SampsonLinearization model(problem, pose);
  MatchScores scores;
  scores.rows.reserve(fitted.size());
  scores.residuals.reserve(fitted.size());
  scores.matches.reserve(fitted.size());
  scores.normals.reserve(fitted.size());
  for (const int index : fitted) {
    const auto i = static_cast<size_t>(index);
    const Correspondence& match = problem.matches[i];
    const SampsonScore residual = model.Score(match, NoiseScaleAt(problem, i));
    scores.matches.push_back(match);
    scores.normals.push_back(residual.gradient.normalized());
    const Vector5d row = residual.g_p / residual.norm;
    scores.rows.push_back(row);
    scores.residuals.push_back(residual.r);
    scores.information += row * row.transpose();
  }
  return scores;
}

Matrix5d ClusteredCovariance(const MatchScores& scores, std::span<const int> groups) {
  const Eigen::LLT<Matrix5d> llt(scores.information);
  if (llt.info() != Eigen::Success) return Matrix5d::Constant(std::numeric_limits<double>::quiet_NaN());
  // In coordinates in which A is the identity.
  const Matrix5d L = llt.matrixL();
  std::vector<Vector5d> rows;
  rows.reserve(scores.rows.size());
  for (const Vector5d& row : scores.rows) rows.push_back(L.triangularView<Eigen::Lower>().solve(row));
  const GroupMembers members(groups);
  Matrix5d whitened = Matrix5d::Zero();
  for (size_t group = 0; group < members.size(); ++group) {
    if (members.Of(group).empty()) continue;
    const Vector5d moved = MoveWithout(members.Of(group), rows, scores.residuals);
    whitened += moved * moved.transpose();
  }
  const Matrix5d half = L.transpose().triangularView<Eigen::Upper>().solve(whitened);
  const Matrix5d covariance = L.transpose().triangularView<Eigen::Upper>().solve(half.transpose());
  return 0.5 * (covariance + covariance.transpose());
}

std::vector<int> Separate(size_t num_matches) {
  std::vector<int> groups(num_matches);
  std::iota(groups.begin(), groups.end(), 0);
  return groups;
}

std::vector<int> KeyPointGroups(const std::vector<Correspondence>& matches, double radius_px) {
  DisjointSets groups(matches.size());
  UniteNeighbours(matches, &Correspondence::x1_px, radius_px, &groups);
  UniteNeighbours(matches, &Correspondence::x2_px, radius_px, &groups);
  return groups.Numbers();
}

std::vector<int> BlockGroups(const Camera& camera1, const std::vector<Correspondence>& matches,
                             int per_side) {
  std::vector<int> groups, number_of(static_cast<size_t>(per_side) * static_cast<size_t>(per_side), -1);
  groups.reserve(matches.size());
  int num_groups = 0;
  const auto block = [&](double x_px, int length_px) {
    return static_cast<size_t>(
        std::clamp(std::floor((x_px + 0.5) / length_px * per_side), 0.0, per_side - 1.0));
  };
  for (const Correspondence& match : matches) {
    int& number = number_of[block(match.x1_px.x(), camera1.width) * static_cast<size_t>(per_side) +
                            block(match.x1_px.y(), camera1.height)];
    if (number < 0) number = num_groups++;
    groups.push_back(number);
  }
  return groups;
}

}  // namespace rcme
