#include "estimator/kernels/direction_noise.h"

#include "estimator/geometry/essential_matrix.h"
#include "estimator/refinement/fit_set.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "estimator/kernels/direction_noise.cc"
#include <hwy/foreach_target.h>
// The above must come before these.
#include "estimator/kernels/epipolar-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

// `F`: the epipolar constraints of the direction t and of its two tangents b1, b2, in whitened coordinates.
// Their gradients are the derivatives of v'm by the noise, m = y x x2. `cov`: [c11, 2 c12, c22] of the
// direction. Writes n11, n12, n22 to `noise`.
void SumNoise(const MatchBlocks& matches, const MatchMask& mask, const double (&F)[3][9],
              const double (&cov)[3], double max_leverage, double* noise) {
  HWY_ALIGN double sums[3][kBlockSize];
  for (int lane = 0; lane < kBlockSize; lane += kLanes) {
    Vec sum[3] = {Set(0.0), Set(0.0), Set(0.0)};
    for (int b = 0; b < matches.num_blocks(); ++b) {
      const Matches m = LoadMatches(matches[b], lane);
      const Constraint t = EvaluateConstraint(Broadcast{F[0]}, m),
                       b1 = EvaluateConstraint(Broadcast{F[1]}, m),
                       b2 = EvaluateConstraint(Broadcast{F[2]}, m);
      const Vec variance = Dot4(t.gradient, t.gradient);
      const Vec own[] = {Dot4(b1.gradient, b1.gradient), Dot4(b1.gradient, b2.gradient),
                         Dot4(b2.gradient, b2.gradient)};
      const Vec trace =
          FusedMulAdd(Set(cov[0]), own[0], FusedMulAdd(Set(cov[1]), own[1], Set(cov[2]) * own[2]));
      const Mask is_used = hn::And(MaskFromBits(static_cast<unsigned>(mask[static_cast<size_t>(b)]) >> lane),
                                   trace <= Set(max_leverage) * variance);
      const Vec inverse = Set(1.0) / variance;
      for (int i = 0; i < 3; ++i) sum[i] = sum[i] + hn::IfThenElseZero(is_used, own[i] * inverse);
    }
    for (int i = 0; i < 3; ++i) Store(sum[i], sums[i] + lane);
  }
  for (int i = 0; i < 3; ++i) noise[i] = SumOfEight(sums[i]);
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rcme {

HWY_EXPORT(SumNoise);

Eigen::Matrix2d SumDirectionNoise(const MatchBlocks& matches, const MatchMask& mask, const RelativePose& pose,
                                  const Eigen::Matrix2d& direction_cov) {
  const Eigen::Matrix<double, 3, 2> tangents = DirectionBasis(pose.t);
  double F[3][9], noise[3];
  int k = 0;
  for (const Eigen::Vector3d& axis :
       {pose.t, Eigen::Vector3d(tangents.col(0)), Eigen::Vector3d(tangents.col(1))})
    WriteRowMajor(matches.FundamentalFromEssential(EssentialFromPose({pose.R, axis})), F[k++]);
  const double cov[] = {direction_cov(0, 0), 2.0 * direction_cov(0, 1), direction_cov(1, 1)};
  HWY_DYNAMIC_DISPATCH(SumNoise)(matches, mask, F, cov, MaxLeverage(CountIn(mask)), noise);
  Eigen::Matrix2d sum;
  sum << noise[0], noise[1], noise[1], noise[2];
  return sum;
}

}  // namespace rcme
#endif
