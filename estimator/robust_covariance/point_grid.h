#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace rcme {

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

}  // namespace rcme
