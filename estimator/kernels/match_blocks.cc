#include "estimator/kernels/match_blocks.h"

#include <bit>

namespace rcme {

MatchBlocks::MatchBlocks(const MotionProblem& problem)
    : blocks_((problem.matches.size() + kBlockSize - 1) / kBlockSize),
      ray_scale_{problem.sigma_px / problem.camera1.fx, problem.sigma_px / problem.camera1.fy,
                 problem.sigma_px / problem.camera2.fx, problem.sigma_px / problem.camera2.fy},
      num_matches_(static_cast<int>(problem.matches.size())) {
  const double unit = 1.0 / problem.sigma_px;
  const Camera &camera1 = problem.camera1, &camera2 = problem.camera2;
  for (size_t i = 0; i < problem.matches.size(); ++i) {
    const Correspondence& match = problem.matches[i];
    MatchBlock& block = blocks_[i / kBlockSize];
    const size_t lane = i % kBlockSize;
    block.x1[lane] = unit * (match.x1_px.x() - camera1.cx);
    block.y1[lane] = unit * (match.x1_px.y() - camera1.cy);
    block.x2[lane] = unit * (match.x2_px.x() - camera2.cx);
    block.y2[lane] = unit * (match.x2_px.y() - camera2.cy);
  }
}

Eigen::Matrix3d MatchBlocks::FundamentalFromEssential(const Eigen::Matrix3d& E) const {
  return Eigen::Vector3d(ray_scale_.x2, ray_scale_.y2, 1.0).asDiagonal() * E *
         Eigen::Vector3d(ray_scale_.x1, ray_scale_.y1, 1.0).asDiagonal();
}

MatchMask MatchBlocks::All() const {
  MatchMask mask(blocks_.size(), 0xff);
  if (const int num_in_last = num_matches_ % kBlockSize) {
    mask.back() = static_cast<std::uint8_t>((1 << num_in_last) - 1);
  }
  return mask;
}

std::vector<int> IndicesOf(const MatchMask& mask) {
  std::vector<int> indices;
  indices.reserve(static_cast<size_t>(CountIn(mask)));
  for (size_t block = 0; block < mask.size(); ++block) {
    for (unsigned bits = mask[block]; bits != 0; bits &= bits - 1) {
      indices.push_back(static_cast<int>(block) * kBlockSize + std::countr_zero(bits));
    }
  }
  return indices;
}

MatchMask MaskOf(std::span<const int> indices, const MatchBlocks& matches) {
  MatchMask mask = matches.Empty();
  for (const int i : indices) {
    std::uint8_t& byte = mask[static_cast<size_t>(i / kBlockSize)];
    byte = static_cast<std::uint8_t>(byte | (1 << (i % kBlockSize)));
  }
  return mask;
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
