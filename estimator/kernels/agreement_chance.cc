#include "estimator/kernels/agreement_chance.h"

#include "estimator/geometry/essential_matrix.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "estimator/kernels/agreement_chance.cc"
#include <hwy/foreach_target.h>
// The above must come before these.
#include "estimator/kernels/epipolar-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

// Share of the box covered by the band around the epipolar line of each first point (x, y), as AreaOfBand of
// motion_chance.cc.
HWY_INLINE Vec ShareOfBox(const double* F, const Box& box, double threshold, Vec x, Vec y) {
  const auto f = [&](int i) { return Set(F[i]); };
  const auto line = [&](int i) { return FusedMulAdd(f(i), x, FusedMulAdd(f(i + 1), y, f(i + 2))); };
  const Vec lx = line(0), ly = line(3), lz = line(6);
  const Vec norm2 = FusedMulAdd(lx, lx, ly * ly), inverse = Set(1.0) / norm2, to_foot = hn::Neg(lz * inverse);
  const Vec foot[] = {lx * to_foot, ly * to_foot}, along[] = {hn::Neg(ly), lx};
  Vec from = Set(0.0), to = Set(0.0);  // ends of the chord, as foot + from * along
  for (int axis = 0; axis < 2; ++axis) {
    const Vec per_step = Set(1.0) / along[axis];
    const Vec a = (Set(box.low[axis]) - foot[axis]) * per_step,
              b = (Set(box.high[axis]) - foot[axis]) * per_step;
    from = axis == 0 ? Lesser(a, b) : Greater(from, Lesser(a, b));
    to = axis == 0 ? Greater(a, b) : Lesser(to, Greater(a, b));
  }
  const auto width = [&](Vec at) {
    const Vec x2 = FusedMulAdd(at, along[0], foot[0]), y2 = FusedMulAdd(at, along[1], foot[1]);
    const Vec l1x = FusedMulAdd(f(0), x2, FusedMulAdd(f(3), y2, f(6)));
    const Vec l1y = FusedMulAdd(f(1), x2, FusedMulAdd(f(4), y2, f(7)));
    const Vec ratio = FusedMulAdd(l1x, l1x, l1y * l1y) * inverse;
    return hn::Sqrt(Set(4.0 * threshold) * (Set(1.0) + ratio));
  };
  const Vec widths = FusedMulAdd(Set(4.0), width(Set(0.5) * (from + to)), width(from) + width(to));
  const Vec area = widths * Set(1.0 / 6.0) * (to - from) * hn::Sqrt(norm2);
  const Vec share = hn::IfThenElseZero(from < to, Lesser(area * Set(1.0 / box.Area()), Set(1.0)));
  return hn::IfThenElse(norm2 > Set(0.0), share, Set(1.0));  // x1 is the epipole: every point agrees
}

double SumShares(const double* F, const Box& box, double threshold, const double* x, const double* y,
                 int count) {
  return SumOverLanes([&](int lane) {
    Vec sum = Set(0.0);
    for (int i = lane; i < count; i += kBlockSize) {
      const Vec share = ShareOfBox(F, box, threshold, Load(x + i), Load(y + i));
      sum = sum + hn::IfThenElseZero(AreMatches(i, count), share);
    }
    return sum;
  });
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rcme {

HWY_EXPORT(SumShares);

double ChanceOfAgreement(const MatchBlocks& matches, const RelativePose& pose, const Box& box,
                         double threshold) {
  alignas(64) double x[kMostLookedAt] = {}, y[kMostLookedAt] = {};
  const int n = matches.num_matches(), stride = (n + kMostLookedAt - 1) / kMostLookedAt;
  int count = 0;
  for (int i = 0; i < n; i += stride, ++count) {
    x[count] = matches[i / kBlockSize].x1[i % kBlockSize];
    y[count] = matches[i / kBlockSize].y1[i % kBlockSize];
  }
  double F[9];
  WriteRowMajor(matches.FundamentalFromEssential(EssentialFromPose(pose)), F);
  return HWY_DYNAMIC_DISPATCH(SumShares)(F, box, threshold, x, y, count) / count;
}

}  // namespace rcme
#endif
