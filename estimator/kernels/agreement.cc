#include "estimator/kernels/agreement.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "estimator/kernels/agreement.cc"
#include <hwy/foreach_target.h>
// The above must come before these.
#include "estimator/kernels/cheirality-inl.h"
#include "estimator/kernels/lanes-inl.h"
#include "estimator/kernels/variance-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

// Matches behind a camera whose parallax is too large to be the noise of a point at infinity (6 sigma).
HWY_INLINE Mask AreClearlyBehind(const TwoViewPose& pose, const RayScale& scale, const Matches& matches,
                                 Vec noise2) {
  const Sides sides = EvaluateSides(pose, scale, matches);
  const Mask are_in_front = hn::And(sides.inverse_depth > Set(0.0), sides.is_ahead_of_camera2);
  const Vec3& y = sides.ray1_in_cam2;
  const Vec inverse_z = Set(1.0) / y.z;
  const Vec parallax_x = FusedMulSub(y.x, inverse_z, sides.ray2.x) / Set(scale.x2);
  const Vec parallax_y = FusedMulSub(y.y, inverse_z, sides.ray2.y) / Set(scale.y2);
  const Mask is_far = FusedMulAdd(parallax_x, parallax_x, Square(parallax_y)) > Set(36.0) * noise2;
  return hn::AndNot(are_in_front, hn::Or(y.z <= Set(0.0), is_far));
}

// Squared noise_scale of the matches.
HWY_INLINE Vec LoadSquaredNoise(const MatchBlocks& matches, int block, int lane) {
  if (matches.noise_scales().empty()) return Set(1.0);
  return Square(Load(matches.noise_scales()[static_cast<size_t>(block)].scale + lane));
}

void FindAgreeingMatches(const MatchBlocks& matches, const TwoViewPose& pose, const double* F,
                         const double* coefficients, const MatchMask& fitted, const AgreementBounds& bounds,
                         MatchMask* agreeing) {
  const Vec limit = Set(bounds.squared_distance), max_leverage = Set(bounds.leverage);
  for (int b = 0; b < matches.num_blocks(); ++b) {
    unsigned bits = 0;
    for (int lane = 0; lane < kBlockSize; lane += kLanes) {
      const Matches m = LoadMatches(matches[b], lane);
      const RankAwareTerms terms = EvaluateRankAware(F, coefficients, m);
      const Vec noise2 = LoadSquaredNoise(matches, b, lane), n2 = terms.n2 * noise2;
      const Mask is_fitted = MaskFromBits(static_cast<unsigned>(fitted[static_cast<size_t>(b)]) >> lane);
      const Vec total = hn::IfThenElse(is_fitted, n2 - terms.variance, n2 + terms.variance);
      const Mask fits = hn::And(terms.g2 <= limit * total, terms.variance <= max_leverage * n2);
      const Mask are_matches = AreMatches(b * kBlockSize + lane, matches.num_matches());
      bits |= ReadMaskBits(hn::And(are_matches,
                                   hn::AndNot(AreClearlyBehind(pose, matches.ray_scale(), m, noise2), fits)))
              << lane;
    }
    (*agreeing)[static_cast<size_t>(b)] = static_cast<std::uint8_t>(bits);
  }
}

FrontCounts CountFront(const MatchBlocks& matches, const MatchMask& mask, const TwoViewPose& pose) {
  FrontCounts counts{0, 0};
  for (int b = 0; b < matches.num_blocks(); ++b) {
    for (int lane = 0; lane < kBlockSize; lane += kLanes) {
      const Sides sides = EvaluateSides(pose, matches.ray_scale(), LoadMatches(matches[b], lane));
      const unsigned ahead = ReadMaskBits(sides.is_ahead_of_camera2) &
                             (static_cast<unsigned>(mask[static_cast<size_t>(b)]) >> lane);
      counts.with_t += __builtin_popcount(ahead & ReadMaskBits(sides.inverse_depth > Set(0.0)));
      counts.with_opposite_t += __builtin_popcount(ahead & ReadMaskBits(sides.inverse_depth < Set(0.0)));
    }
  }
  return counts;
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rcme {

HWY_EXPORT(FindAgreeingMatches);
HWY_EXPORT(CountFront);

void FindAgreeing(const MatchBlocks& matches, const RelativePose& pose, const double* F,
                  const VariancePolynomial& variance, const MatchMask& fitted, const AgreementBounds& bounds,
                  MatchMask* agreeing) {
  HWY_DYNAMIC_DISPATCH(FindAgreeingMatches)
  (matches, TwoViewPose(pose), F, variance.coefficients, fitted, bounds, agreeing);
}

FrontCounts CountInFront(const MatchBlocks& matches, const MatchMask& mask, const RelativePose& pose) {
  return HWY_DYNAMIC_DISPATCH(CountFront)(matches, mask, TwoViewPose(pose));
}

RelativePose SelectPoseByCheirality(const MatchBlocks& matches, const MatchMask& mask,
                                    const EssentialProjection& projection) {
  const std::array<RelativePose, 4> poses = PosesFromEssential(projection);  // R_a t, R_a -t, R_b t, R_b -t
  size_t best = 0;
  int most = -1;
  for (size_t k = 0; k < poses.size(); k += 2) {
    const FrontCounts counts = CountInFront(matches, mask, poses[k]);
    for (const auto& [count, index] : {std::pair{counts.with_t, k}, {counts.with_opposite_t, k + 1}}) {
      if (count > most) {
        most = count;
        best = index;
      }
    }
  }
  return poses[best];
}

}  // namespace rcme
#endif
