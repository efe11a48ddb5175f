#include "estimator/kernels/sampson_equations.h"

#include "estimator/geometry/essential_matrix.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "estimator/kernels/sampson_equations.cc"
#include <hwy/foreach_target.h>
// The above must come before these.
#include <hwy/contrib/math/math-inl.h>

#include "estimator/kernels/epipolar-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

HWY_INLINE void AddTriangle(const Vec* a, Vec weight, Vec* sums) {
  for (int row = 0, i = 0; row < 5; ++row) {
    const Vec weighted = weight * a[row];
    for (int c = 0; c <= row; ++c, ++i) sums[i] = hn::MulAdd(weighted, a[c], sums[i]);
  }
}

template <Loss loss>
HWY_INLINE void Sum(const MatchBlocks& matches, const MatchMask& mask, const SampsonModel& model, SampsonSums* sums) {
  const Vec zero = Set(0.0), one = Set(1.0);
  const Vec c2 = Set(kCauchyScale * kCauchyScale), inverse_c2 = Set(1.0 / (kCauchyScale * kCauchyScale));
  Vec cost = zero, gradient[5], hessian[15], information[15];
  for (Vec& sum : gradient) sum = zero;
  for (Vec& sum : hessian) sum = zero;
  for (Vec& sum : information) sum = zero;
  for (int b = 0; b < matches.num_blocks(); ++b) {
    for (int lane = 0; lane < kBlockSize; lane += kLanes) {
      const Mask is_used = MaskFromBits(static_cast<unsigned>(mask[static_cast<size_t>(b)]) >> lane);
      const Matches m = LoadMatches(matches[b], lane);
      const Constraint c = EvaluateConstraint(Broadcast{model.F}, m);
      const Vec n2 = hn::IfThenElse(is_used, Dot4(c.gradient, c.gradient), one);
      const Vec unit = hn::IfThenElseZero(is_used, one / hn::Sqrt(n2));
      const Vec r = c.g * unit, r_over_n = r * unit;
      Vec g_p[5], r_p[5];
      for (int k = 0; k < 5; ++k) {
        const Constraint d = EvaluateConstraint(Broadcast{model.dF[k]}, m);
        g_p[k] = d.g * unit;
        r_p[k] = hn::NegMulAdd(r_over_n * unit, Dot4(c.gradient, d.gradient), g_p[k]);
      }
      const Vec r2 = r * r;
      Vec weight = one;
      if constexpr (loss == Loss::kCauchy) {
        const Vec ratio = hn::MulAdd(r2, inverse_c2, one);
        weight = one / ratio;
        cost = hn::MulAdd(c2, hn::Log(Tag(), ratio), cost);
      } else {
        cost = cost + r2;
      }
      for (int k = 0; k < 5; ++k) gradient[k] = hn::MulAdd(weight * r, r_p[k], gradient[k]);
      AddTriangle(r_p, weight, hessian);
      AddTriangle(g_p, one, information);
    }
  }
  const auto total = [](Vec sum) { return hn::GetLane(hn::SumOfLanes(Tag(), sum)); };
  sums->cost = 0.5 * total(cost);
  for (int k = 0; k < 5; ++k) sums->gradient[k] = total(gradient[k]);
  for (int i = 0; i < 15; ++i) sums->hessian[i] = total(hessian[i]);
  for (int i = 0; i < 15; ++i) sums->information[i] = total(information[i]);
}

void SumSquared(const MatchBlocks& matches, const MatchMask& mask, const SampsonModel& model, SampsonSums* sums) {
  Sum<Loss::kSquared>(matches, mask, model, sums);
}
void SumCauchy(const MatchBlocks& matches, const MatchMask& mask, const SampsonModel& model, SampsonSums* sums) {
  Sum<Loss::kCauchy>(matches, mask, model, sums);
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rcme {

HWY_EXPORT(SumSquared);
HWY_EXPORT(SumCauchy);

NormalEquations LinearizeSampson(const MatchBlocks& matches, const MatchMask& mask, const RelativePose& pose,
                                 Loss loss) {
  SampsonModel model;
  WriteRowMajor(matches.FundamentalFromEssential(EssentialFromPose(pose)), model.F);
  const std::array<Eigen::Matrix3d, 5> dE = EssentialTangent(pose);
  for (size_t k = 0; k < 5; ++k) WriteRowMajor(matches.FundamentalFromEssential(dE[k]), model.dF[k]);

  SampsonSums sums;
  if (loss == Loss::kCauchy) {
    HWY_DYNAMIC_DISPATCH(SumCauchy)(matches, mask, model, &sums);
  } else {
    HWY_DYNAMIC_DISPATCH(SumSquared)(matches, mask, model, &sums);
  }
  NormalEquations equations;
  equations.cost = sums.cost;
  for (int row = 0, i = 0; row < 5; ++row) {
    equations.gradient(row) = sums.gradient[row];
    for (int c = 0; c <= row; ++c, ++i) {
      equations.hessian(row, c) = equations.hessian(c, row) = sums.hessian[i];
      equations.information(row, c) = equations.information(c, row) = sums.information[i];
    }
  }
  return equations;
}

}  // namespace rcme
#endif
