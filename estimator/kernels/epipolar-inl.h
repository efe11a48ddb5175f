// The epipolar constraint g = x2' F x1 and its gradient for several matches, or several hypotheses, side by
// side.
#if defined(RCME_ESTIMATOR_KERNELS_EPIPOLAR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RCME_ESTIMATOR_KERNELS_EPIPOLAR_INL_H_
#undef RCME_ESTIMATOR_KERNELS_EPIPOLAR_INL_H_
#else
#define RCME_ESTIMATOR_KERNELS_EPIPOLAR_INL_H_
#endif

#include "estimator/kernels/lanes-inl.h"
#include "estimator/kernels/match_blocks.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

struct Matches {
  Vec x1, y1, x2, y2;
};
HWY_INLINE Matches LoadMatches(const MatchBlock& block, int lane) {
  return {Load(block.x1 + lane), Load(block.y1 + lane), Load(block.x2 + lane), Load(block.y2 + lane)};
}
// Mask of the lanes, from `first_match` on, that hold matches.
HWY_INLINE Mask AreMatches(int first_match, int num_matches) {
  return hn::FirstN(Tag(), static_cast<size_t>(num_matches > first_match ? num_matches - first_match : 0));
}

// The sum over the lanes of a block. sum_lanes(lane) returns the partial sums of the vector that starts
// there.
template <typename SumLanes>
HWY_INLINE double SumOverLanes(const SumLanes& sum_lanes) {
  HWY_ALIGN double sums[kBlockSize];
  for (int lane = 0; lane < kBlockSize; lane += kLanes) Store(sum_lanes(lane), sums + lane);
  return SumOfEight(sums);
}

// g and its gradient with respect to (x1, y1, x2, y2).
struct Constraint {
  Vec g, gradient[4];
};

// F(i), i = 0..8 row by row, returns the entry as a Vec: one model for all lanes, or one per lane.
template <typename Entries>
HWY_INLINE Constraint EvaluateConstraint(const Entries& F, const Matches& m) {
  Constraint c;
  c.gradient[0] = FusedMulAdd(F(0), m.x2, FusedMulAdd(F(3), m.y2, F(6)));
  c.gradient[1] = FusedMulAdd(F(1), m.x2, FusedMulAdd(F(4), m.y2, F(7)));
  c.gradient[2] = FusedMulAdd(F(0), m.x1, FusedMulAdd(F(1), m.y1, F(2)));
  c.gradient[3] = FusedMulAdd(F(3), m.x1, FusedMulAdd(F(4), m.y1, F(5)));
  const Vec last = FusedMulAdd(F(6), m.x1, FusedMulAdd(F(7), m.y1, F(8)));
  c.g = FusedMulAdd(m.x2, c.gradient[2], FusedMulAdd(m.y2, c.gradient[3], last));
  return c;
}

HWY_INLINE Vec Dot4(const Vec* a, const Vec* b) {
  return FusedMulAdd(a[0], b[0], FusedMulAdd(a[1], b[1], FusedMulAdd(a[2], b[2], a[3] * b[3])));
}

// One model for all lanes.
struct Broadcast {
  const double* entries;
  HWY_INLINE Vec operator()(int i) const { return Set(entries[i]); }
};

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
