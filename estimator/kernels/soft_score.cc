#include "estimator/kernels/soft_score.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "estimator/kernels/soft_score.cc"
#include <hwy/foreach_target.h>
// The above must come before these.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// F over its largest entry, in single precision: products of such entries stay within its range. False if
// there is no positive largest entry.
bool DivideByLargest(const double* F, float* entries) {
  using DoubleTag = hn::CappedTag<double, 8>;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(DoubleTag()));
  const DoubleTag d;
  const hn::Rebind<float, DoubleTag> of_entries;
  auto magnitude = hn::Zero(d);
  for (int i = 0; i < 8; i += kLanes) magnitude = hn::Max(magnitude, hn::Abs(hn::LoadU(d, F + i)));
  const double largest = std::max(hn::GetLane(hn::MaxOfLanes(d, magnitude)), F[8] < 0.0 ? -F[8] : F[8]);
  if (!(largest > 0.0)) return false;
  for (int i = 0; i < 8; i += kLanes)
    hn::StoreU(hn::DemoteTo(of_entries, hn::LoadU(d, F + i) / hn::Set(d, largest)), of_entries, entries + i);
  entries[8] = static_cast<float>(F[8] / largest);
  return true;
}

// Each product and sum is rounded separately, and each place of a block has its own partial sum. So every
// instruction set gives the same bits.
double SumOverBlocks(const ScoreBlock* blocks, int num_matches, const double* F, float s2) {
  float entries[9];
  if (!DivideByLargest(F, entries)) return 0.0;
  using FloatTag = hn::CappedTag<float, kScoreBlockSize>;
  using FloatVec = hn::Vec<FloatTag>;
  constexpr int kFloatLanes = static_cast<int>(hn::MaxLanes(FloatTag()));
  const FloatTag d;
  alignas(64) float partial[kScoreBlockSize];
  FloatVec f[9];
  for (int i = 0; i < 9; ++i) f[i] = hn::Set(d, entries[i]);
  const FloatVec scale = hn::Set(d, s2);
  for (int lane = 0; lane < kScoreBlockSize; lane += kFloatLanes) {
    FloatVec sum = hn::Zero(d);
    for (int first = 0; first < num_matches; first += kScoreBlockSize) {
      const ScoreBlock& block = blocks[first / kScoreBlockSize];
      const FloatVec x1 = hn::Load(d, block.x1 + lane), y1 = hn::Load(d, block.y1 + lane);
      const FloatVec x2 = hn::Load(d, block.x2 + lane), y2 = hn::Load(d, block.y2 + lane);
      const FloatVec a = f[0] * x2 + f[3] * y2 + f[6], b = f[1] * x2 + f[4] * y2 + f[7];
      const FloatVec u = f[0] * x1 + f[1] * y1 + f[2], v = f[3] * x1 + f[4] * y1 + f[5];
      const FloatVec g = x2 * u + y2 * v + (f[6] * x1 + f[7] * y1 + f[8]);
      const FloatVec n2 = scale * (a * a + b * b + u * u + v * v);
      const FloatVec score = n2 / (n2 + g * g);
      const int left = num_matches - first - lane;
      sum = sum + (left >= kFloatLanes
                       ? score
                       : hn::IfThenElseZero(hn::FirstN(d, static_cast<size_t>(left > 0 ? left : 0)), score));
    }
    hn::Store(sum, d, partial + lane);
  }
  double total = 0.0;
  for (const float sum : partial) total += static_cast<double>(sum);
  return total;
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rcme {

HWY_EXPORT(SumOverBlocks);

ScoreMatches::ScoreMatches(const MatchBlocks& matches)
    : blocks_(static_cast<size_t>((matches.num_matches() + kScoreBlockSize - 1) / kScoreBlockSize)),
      num_matches_(matches.num_matches()) {
  for (int i = 0; i < num_matches_; ++i) {
    const MatchBlock& from = matches[i / kBlockSize];
    ScoreBlock& to = blocks_[static_cast<size_t>(i / kScoreBlockSize)];
    const int lane = i % kBlockSize, place = i % kScoreBlockSize;
    to.x1[place] = static_cast<float>(from.x1[lane]);
    to.y1[place] = static_cast<float>(from.y1[lane]);
    to.x2[place] = static_cast<float>(from.x2[lane]);
    to.y2[place] = static_cast<float>(from.y2[lane]);
  }
}

double ScoreMatches::SumScores(const double* F, double scale, int first, int end) const {
  if (end <= first) return 0.0;
  const double sum = HWY_DYNAMIC_DISPATCH(SumOverBlocks)(blocks_.data() + first / kScoreBlockSize,
                                                         std::min(end, num_matches_) - first, F,
                                                         static_cast<float>(scale * scale));
  return sum == sum ? sum : 0.0;
}

}  // namespace rcme
#endif
