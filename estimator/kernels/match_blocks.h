// The matches of a problem as the kernels read them: blocks of eight, one array per coordinate.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "estimator/motion_problem.h"

namespace rcme {

// Matches (or hypotheses) side by side in a block; every vector width of the kernels divides it.
inline constexpr int kBlockSize = 8;

// Eight matches in whitened coordinates: pixels from the principal point in units of sigma, so that the noise
// has variance 1. Lanes beyond the last match hold zeros.
struct alignas(64) MatchBlock {
  double x1[kBlockSize], y1[kBlockSize], x2[kBlockSize], y2[kBlockSize];
};

// A set of matches: bit l of byte b is match 8 b + l.
using MatchMask = std::vector<std::uint8_t>;

// Rays from whitened coordinates: [scale.x x, scale.y y, 1], scale = sigma / focal length.
struct RayScale {
  double x1, y1, x2, y2;
};

class MatchBlocks {
 public:
  explicit MatchBlocks(const MotionProblem& problem);

  int num_matches() const { return num_matches_; }
  int num_blocks() const { return static_cast<int>(blocks_.size()); }
  const MatchBlock* data() const { return blocks_.data(); }
  const MatchBlock& operator[](int block) const { return blocks_[static_cast<size_t>(block)]; }
  const RayScale& ray_scale() const { return ray_scale_; }

  // F with x2' F x1 = 0 in whitened coordinates, of an E in rays. Linear in E, so it maps tangents too.
  Eigen::Matrix3d FundamentalFromEssential(const Eigen::Matrix3d& E) const;

  MatchMask Empty() const { return MatchMask(blocks_.size(), 0); }
  MatchMask All() const;

 private:
  std::vector<MatchBlock> blocks_;
  RayScale ray_scale_;
  int num_matches_;
};

// A 3x3 matrix as nine numbers, row by row.
inline void WriteRowMajor(const Eigen::Matrix3d& matrix, double* to) {
  for (int i = 0; i < 9; ++i) to[i] = matrix(i / 3, i % 3);
}

// Indices of the matches in the mask, ascending, and back.
std::vector<int> IndicesOf(const MatchMask& mask);
MatchMask MaskOf(std::span<const int> indices, const MatchBlocks& matches);

int CountIn(const MatchMask& mask);
// Number of matches in both.
int CountInBoth(const MatchMask& a, const MatchMask& b);

}  // namespace rcme
