// The matches of a problem in the layout of the kernels: blocks of eight, one array per coordinate.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "estimator/match_whitening.h"

namespace rcme {

// Number of matches (or hypotheses) in a block, a multiple of every vector width of the kernels.
inline constexpr int kBlockSize = 8;

// Eight matches in whitened coordinates (match_whitening.h). Lanes beyond the last match hold zeros.
struct alignas(64) MatchBlock {
  double x1[kBlockSize], y1[kBlockSize], x2[kBlockSize], y2[kBlockSize];
};

// The noise scales of eight matches (MotionProblem::noise_scale) and their inverses; 1 beyond the last match.
struct alignas(64) ScaleBlock {
  double scale[kBlockSize], inverse[kBlockSize];
};

// A set of matches: bit l of byte b is match 8 b + l.
using MatchMask = std::vector<std::uint8_t>;

class MatchBlocks {
 public:
  explicit MatchBlocks(const MotionProblem& problem);

  int num_matches() const { return num_matches_; }
  int num_blocks() const { return static_cast<int>(blocks_.size()); }
  const MatchBlock* data() const { return blocks_.data(); }
  const MatchBlock& operator[](int block) const { return blocks_[static_cast<size_t>(block)]; }
  // Empty if all are 1.
  const std::vector<ScaleBlock>& noise_scales() const { return noise_scales_; }
  double NoiseScaleAt(size_t match) const {
    return noise_scales_.empty() ? 1.0 : noise_scales_[match / kBlockSize].scale[match % kBlockSize];
  }
  const RayScale& ray_scale() const { return whitening_.ray_scale(); }
  Eigen::Matrix3d FundamentalFromEssential(const Eigen::Matrix3d& E) const {
    return whitening_.FundamentalFromEssential(E);
  }

  MatchMask Empty() const { return MatchMask(blocks_.size(), 0); }
  MatchMask All() const;

 private:
  std::vector<MatchBlock> blocks_;
  std::vector<ScaleBlock> noise_scales_;
  MatchWhitening whitening_;
  int num_matches_;
};

// A 3x3 matrix as nine numbers, row by row.
inline void WriteRowMajor(const Eigen::Matrix3d& matrix, double* to) {
  for (int i = 0; i < 9; ++i) to[i] = matrix(i / 3, i % 3);
}

// The indices of the matches in the mask, ascending; and the mask of given indices.
std::vector<int> ListIndices(const MatchMask& mask);
MatchMask MakeMask(std::span<const int> indices, const MatchBlocks& matches);

MatchMask Intersection(const MatchMask& a, const MatchMask& b);

int CountIn(const MatchMask& mask);
// Number of matches in both masks.
int CountInBoth(const MatchMask& a, const MatchMask& b);

}  // namespace rcme
