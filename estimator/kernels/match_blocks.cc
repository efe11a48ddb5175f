#include "estimator/kernels/match_blocks.h"

#include <bit>

namespace rcme {

MatchBlocks::MatchBlocks(const MotionProblem& problem)
    : blocks_((problem.matches.size() + kBlockSize - 1) / kBlockSize),
      whitening_(problem),
      num_matches_(static_cast<int>(problem.matches.size())) {
  for (size_t i = 0; i < problem.matches.size(); ++i) {
    const Eigen::Vector2d x1 = whitening_.WhitenPoint1(problem.matches[i].x1_px);
    const Eigen::Vector2d x2 = whitening_.WhitenPoint2(problem.matches[i].x2_px);
    MatchBlock& block = blocks_[i / kBlockSize];
    const size_t lane = i % kBlockSize;
    block.x1[lane] = x1.x();
    block.y1[lane] = x1.y();
    block.x2[lane] = x2.x();
    block.y2[lane] = x2.y();
  }
  if (problem.noise_scale.empty()) return;
  noise_scales_.resize(blocks_.size());
  for (size_t i = 0; i < blocks_.size() * kBlockSize; ++i) {
    const double scale = i < problem.matches.size() ? problem.noise_scale[i] : 1.0;
    noise_scales_[i / kBlockSize].scale[i % kBlockSize] = scale;
    noise_scales_[i / kBlockSize].inverse[i % kBlockSize] = 1.0 / scale;
  }
}

MatchMask MatchBlocks::All() const {
  MatchMask mask(blocks_.size(), 0xff);
  if (const int num_in_last = num_matches_ % kBlockSize) {
    mask.back() = static_cast<std::uint8_t>((1 << num_in_last) - 1);
  }
  return mask;
}

std::vector<int> ListIndices(const MatchMask& mask) {
  std::vector<int> indices;
  indices.reserve(static_cast<size_t>(CountIn(mask)));
  for (size_t block = 0; block < mask.size(); ++block) {
    for (unsigned bits = mask[block]; bits != 0; bits &= bits - 1) {
      indices.push_back(static_cast<int>(block) * kBlockSize + std::countr_zero(bits));
    }
  }
  return indices;
}

MatchMask MakeMask(std::span<const int> indices, const MatchBlocks& matches) {
  MatchMask mask = matches.Empty();
  for (const int i : indices) {
    std::uint8_t& byte = mask[static_cast<size_t>(i / kBlockSize)];
    byte = static_cast<std::uint8_t>(byte | (1 << (i % kBlockSize)));
  }
  return mask;
}

MatchMask Intersection(const MatchMask& a, const MatchMask& b) {
  MatchMask both(a.size());
  for (size_t block = 0; block < a.size(); ++block) both[block] = a[block] & b[block];
  return both;
}

int CountIn(const MatchMask& mask) { return CountInBoth(mask, mask); }

int CountInBoth(const MatchMask& a, const MatchMask& b) {
  int count = 0;
  for (size_t block = 0; block < a.size(); ++block) {
    count += std::popcount(static_cast<unsigned>(a[block] & b[block]));
  }
  return count;
}

}  // namespace rcme
