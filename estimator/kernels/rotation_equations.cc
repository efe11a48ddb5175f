#include "estimator/kernels/rotation_equations.h"

#include "estimator/kernels/two_view_pose.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "estimator/kernels/rotation_equations.cc"
#include <hwy/foreach_target.h>
// The above must come before these.
#include "estimator/kernels/epipolar-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

struct Transfer {
  Vec p, q;          // h(x1) as a ray [p, q, 1]
  Vec e[2], w[3];    // e; C^-1 as [w0 w1; w1 w2]
  Vec squared;       // d2
  Mask is_in_front;  // of camera 2
};

HWY_INLINE Transfer EvaluateTransfer(const TwoViewPose& pose, const RayScale& scale, const Matches& m) {
  const auto R = [&](int i) { return Set(pose.R[i]); };
  const Vec a = m.x1 * Set(scale.x1), b = m.y1 * Set(scale.y1);
  const auto row = [&](int i) { return FusedMulAdd(R(i), a, FusedMulAdd(R(i + 1), b, R(i + 2))); };
  const Vec z = row(6), inverse_z = Set(1.0) / z;
  Transfer t;
  t.p = row(0) * inverse_z;
  t.q = row(3) * inverse_z;
  t.is_in_front = z > Set(0.0);
  const Vec to_x = Set(1.0 / scale.x2), to_y = Set(1.0 / scale.y2);
  t.e[0] = FusedNegMulAdd(t.p, to_x, m.x2);
  t.e[1] = FusedNegMulAdd(t.q, to_y, m.y2);
  // J: d(p, q) / d(a, b), in whitened units.
  const Vec scale_a = inverse_z * Set(scale.x1), scale_b = inverse_z * Set(scale.y1);
  const Vec pa = FusedNegMulAdd(t.p, R(6), R(0)) * scale_a * to_x;
  const Vec pb = FusedNegMulAdd(t.p, R(7), R(1)) * scale_b * to_x;
  const Vec qa = FusedNegMulAdd(t.q, R(6), R(3)) * scale_a * to_y;
  const Vec qb = FusedNegMulAdd(t.q, R(7), R(4)) * scale_b * to_y;
  const Vec c00 = FusedMulAdd(pa, pa, FusedMulAdd(pb, pb, Set(1.0)));
  const Vec c11 = FusedMulAdd(qa, qa, FusedMulAdd(qb, qb, Set(1.0)));
  const Vec c01 = FusedMulAdd(pa, qa, pb * qb);
  const Vec inverse = Set(1.0) / FusedMulSub(c00, c11, c01 * c01);
  t.w[0] = c11 * inverse;
  t.w[1] = hn::Neg(c01 * inverse);
  t.w[2] = c00 * inverse;
  t.squared = FusedMulAdd(t.e[0], FusedMulAdd(t.w[0], t.e[0], t.w[1] * t.e[1]),
                          t.e[1] * FusedMulAdd(t.w[1], t.e[0], t.w[2] * t.e[1]));
  return t;
}

// Sums of a lane's matches: energy, gradient (3) and lower triangle of the Hessian (6).
template <Loss loss>
HWY_INLINE void SumLane(const MatchBlocks& matches, const MatchMask& mask, const TwoViewPose& pose, int lane,
                        Vec (&sums)[10]) {
  const RayScale& scale = matches.ray_scale();
  const Vec one = Set(1.0), to_x = Set(1.0 / scale.x2), to_y = Set(1.0 / scale.y2);
  for (Vec& sum : sums) sum = Set(0.0);
  for (int b = 0; b < matches.num_blocks(); ++b) {
    const Transfer t = EvaluateTransfer(pose, scale, LoadMatches(matches[b], lane));
    const Mask is_used =
        hn::And(MaskFromBits(static_cast<unsigned>(mask[static_cast<size_t>(b)]) >> lane), t.is_in_front);
    const Vec d2 = hn::IfThenElseZero(is_used, t.squared);
    Vec weight = hn::IfThenElseZero(is_used, one);
    if constexpr (loss == Loss::kCauchy) {
      weight = weight / FusedMulAdd(d2, Set(1.0 / (kCauchyScale * kCauchyScale)), one);
    }
    // With y = [p, q, 1] up to its length, dy = w x y moves p by -pq w0 + (1 + p^2) w1 - q w2, and q by
    // -(1 + q^2) w0 + pq w1 + p w2.
    const Vec pq = t.p * t.q;
    const Vec gx[] = {hn::Neg(pq) * to_x, FusedMulAdd(t.p, t.p, one) * to_x, hn::Neg(t.q) * to_x};
    const Vec gy[] = {hn::Neg(FusedMulAdd(t.q, t.q, one)) * to_y, pq * to_y, t.p * to_y};
    sums[0] = sums[0] + d2;
    for (int row = 0, i = 4; row < 3; ++row) {
      const auto masked = [&](Vec x) { return hn::IfThenElseZero(is_used, x * weight); };
      const Vec wx = masked(FusedMulAdd(t.w[0], gx[row], t.w[1] * gy[row]));
      const Vec wy = masked(FusedMulAdd(t.w[1], gx[row], t.w[2] * gy[row]));
      sums[1 + row] = FusedNegMulAdd(wx, hn::IfThenElseZero(is_used, t.e[0]),
                                     FusedNegMulAdd(wy, hn::IfThenElseZero(is_used, t.e[1]), sums[1 + row]));
      for (int c = 0; c <= row; ++c, ++i) {
        sums[i] = FusedMulAdd(wx, hn::IfThenElseZero(is_used, gx[c]),
                              FusedMulAdd(wy, hn::IfThenElseZero(is_used, gy[c]), sums[i]));
      }
    }
  }
}

template <Loss loss>
void Sum(const MatchBlocks& matches, const MatchMask& mask, const TwoViewPose& pose, double* totals) {
  HWY_ALIGN double partial[10][kBlockSize];
  for (int lane = 0; lane < kBlockSize; lane += kLanes) {
    Vec sums[10];
    SumLane<loss>(matches, mask, pose, lane, sums);
    for (int i = 0; i < 10; ++i) Store(sums[i], partial[i] + lane);
  }
  for (int i = 0; i < 10; ++i) totals[i] = SumOfEight(partial[i]);
}

void SumSquaredTransfers(const MatchBlocks& matches, const MatchMask& mask, const TwoViewPose& pose,
                         double* totals) {
  Sum<Loss::kSquared>(matches, mask, pose, totals);
}
void SumRobustTransfers(const MatchBlocks& matches, const MatchMask& mask, const TwoViewPose& pose,
                        double* totals) {
  Sum<Loss::kCauchy>(matches, mask, pose, totals);
}

void ScanTransfers(const MatchBlocks& matches, const TwoViewPose& pose, double threshold, InlierScan* scan) {
  scan->num_inliers = 0;
  for (int b = 0; b < matches.num_blocks(); ++b) {
    unsigned bits = 0;
    for (int lane = 0; lane < kBlockSize; lane += kLanes) {
      const Transfer t = EvaluateTransfer(pose, matches.ray_scale(), LoadMatches(matches[b], lane));
      const Mask are_matches = AreMatches(b * kBlockSize + lane, matches.num_matches());
      bits |= ReadMaskBits(hn::And(are_matches, hn::And(t.is_in_front, t.squared <= Set(threshold)))) << lane;
    }
    scan->inliers[static_cast<size_t>(b)] = static_cast<std::uint8_t>(bits);
    scan->num_inliers += __builtin_popcount(bits);
  }
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rcme {

HWY_EXPORT(SumSquaredTransfers);
HWY_EXPORT(SumRobustTransfers);
HWY_EXPORT(ScanTransfers);

RotationEquations LinearizeRotation(const MatchBlocks& matches, const MatchMask& mask,
                                    const Eigen::Matrix3d& R, Loss loss) {
  const TwoViewPose pose(RelativePose{.R = R});
  double totals[10];
  if (loss == Loss::kCauchy) {
    HWY_DYNAMIC_DISPATCH(SumRobustTransfers)(matches, mask, pose, totals);
  } else {
    HWY_DYNAMIC_DISPATCH(SumSquaredTransfers)(matches, mask, pose, totals);
  }
  RotationEquations equations;
  equations.energy = totals[0];
  for (int row = 0, i = 4; row < 3; ++row) {
    equations.gradient(row) = totals[1 + row];
    for (int c = 0; c <= row; ++c, ++i) equations.hessian(row, c) = equations.hessian(c, row) = totals[i];
  }
  return equations;
}

void ScanRotation(const MatchBlocks& matches, const Eigen::Matrix3d& R, double threshold, InlierScan* scan) {
  HWY_DYNAMIC_DISPATCH(ScanTransfers)(matches, TwoViewPose(RelativePose{.R = R}), threshold, scan);
}

}  // namespace rcme
#endif
