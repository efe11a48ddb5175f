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

HWY_INLINE double Total(Vec sum) { return hn::GetLane(hn::SumOfLanes(Tag(), sum)); }

// Calls visit(matches, constraint, 1 / |J|^2, i) for every vector of matches, the i-th; 1 / |J|^2 is zero
// where unused.
template <typename Visit>
HWY_INLINE void ForEach(const MatchBlocks& matches, const MatchMask& mask, const SampsonModel& model,
                        const Visit& visit) {
  for (int b = 0; b < matches.num_blocks(); ++b) {
    const unsigned used = mask[static_cast<size_t>(b)];
    for (int lane = 0; lane < kBlockSize; lane += kLanes) {
      const Mask is_used = MaskFromBits(used >> lane);
      const Matches m = LoadMatches(matches[b], lane);
      const Constraint c = EvaluateConstraint(Broadcast{model.F}, m);
      const Vec n2 = hn::IfThenElse(is_used, Dot4(c.gradient, c.gradient), Set(1.0));
      visit(m, c, hn::IfThenElseZero(is_used, Set(1.0) / n2), (b * kBlockSize + lane) / kLanes);
    }
  }
}

// sum log x of numbers x >= 1, one logarithm for eight vectors of them, i = 0, 1, ...; each up to 1e38.
class LogSum {
 public:
  HWY_INLINE LogSum() : product_(Set(1.0)), sum_(Set(0.0)) {}
  HWY_INLINE void Add(Vec x, int i) {
    product_ = product_ * x;
    if (i % 8 == 7) Flush();
  }
  HWY_INLINE Vec Get() {
    Flush();
    return sum_;
  }

 private:
  HWY_INLINE void Flush() {
    sum_ = sum_ + hn::Log(Tag(), product_);
    product_ = Set(1.0);
  }
  Vec product_, sum_;
};

// With u = g / |J|^2 and e_k = g_k - u J'J_k: r^2 = g u, r dr/dp_k = u e_k, dr/dp_k dr/dp_l = e_k e_l /
// |J|^2. No root is needed.
template <Loss loss>
HWY_INLINE void Sum(const MatchBlocks& matches, const MatchMask& mask, const SampsonModel& model,
                    SampsonSums* sums) {
  const Vec zero = Set(0.0), one = Set(1.0), inverse_c2 = Set(1.0 / (kCauchyScale * kCauchyScale));
  Vec squares = zero, gradient[5] = {zero, zero, zero, zero, zero}, hessian[15];
  for (Vec& sum : hessian) sum = zero;
  LogSum logs;
  ForEach(matches, mask, model, [&](const Matches& m, const Constraint& c, Vec inverse_n2, int i) {
    const Vec u = c.g * inverse_n2, r2 = c.g * u;
    Vec e[5];
    for (int k = 0; k < 5; ++k) {
      const Constraint d = EvaluateConstraint(Broadcast{model.dF[k]}, m);
      e[k] = hn::NegMulAdd(u, Dot4(c.gradient, d.gradient), d.g);
    }
    Vec weight = u, curvature = inverse_n2;
    if constexpr (loss == Loss::kCauchy) {
      // rho = c2 log(1 + r2 / c2), w = rho' = 1 / (1 + r2 / c2), psi' = 2 w^2 - w.
      const Vec ratio = hn::MulAdd(r2, inverse_c2, one), w = one / ratio;
      logs.Add(ratio, i);
      weight = weight * w;
      curvature = curvature * hn::Max(hn::MulSub(w + w, w, w), Set(0.7) * w);
    } else {
      squares = squares + r2;
    }
    for (int k = 0; k < 5; ++k) gradient[k] = hn::MulAdd(weight, e[k], gradient[k]);
    AddTriangle(e, curvature, hessian);
  });
  sums->cost =
      loss == Loss::kCauchy ? 0.5 * kCauchyScale * kCauchyScale * Total(logs.Get()) : 0.5 * Total(squares);
  for (int k = 0; k < 5; ++k) sums->gradient[k] = Total(gradient[k]);
  for (int i = 0; i < 15; ++i) sums->hessian[i] = Total(hessian[i]);
}

void SumSquared(const MatchBlocks& matches, const MatchMask& mask, const SampsonModel& model,
                SampsonSums* sums) {
  Sum<Loss::kSquared>(matches, mask, model, sums);
}
void SumCauchy(const MatchBlocks& matches, const MatchMask& mask, const SampsonModel& model,
               SampsonSums* sums) {
  Sum<Loss::kCauchy>(matches, mask, model, sums);
}

void SumInformation(const MatchBlocks& matches, const MatchMask& mask, const SampsonModel& model,
                    double* triangle) {
  Vec information[15];
  for (Vec& sum : information) sum = Set(0.0);
  ForEach(matches, mask, model, [&](const Matches& m, const Constraint&, Vec inverse_n2, int) {
    Vec g_p[5];
    for (int k = 0; k < 5; ++k) g_p[k] = EvaluateConstraint(Broadcast{model.dF[k]}, m).g;
    AddTriangle(g_p, inverse_n2, information);
  });
  for (int i = 0; i < 15; ++i) triangle[i] = Total(information[i]);
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rcme {

HWY_EXPORT(SumSquared);
HWY_EXPORT(SumCauchy);

HWY_EXPORT(SumInformation);

namespace {

SampsonModel ModelAt(const MatchBlocks& matches, const RelativePose& pose) {
  SampsonModel model;
  WriteRowMajor(matches.FundamentalFromEssential(EssentialFromPose(pose)), model.F);
  const std::array<Eigen::Matrix3d, 5> dE = EssentialTangent(pose);
  for (size_t k = 0; k < 5; ++k) WriteRowMajor(matches.FundamentalFromEssential(dE[k]), model.dF[k]);
  return model;
}

Matrix5d FromTriangle(const double* triangle) {
  Matrix5d matrix;
  for (int row = 0, i = 0; row < 5; ++row) {
    for (int c = 0; c <= row; ++c, ++i) matrix(row, c) = matrix(c, row) = triangle[i];
  }
  return matrix;
}

}  // namespace

NormalEquations LinearizeSampson(const MatchBlocks& matches, const MatchMask& mask, const RelativePose& pose,
                                 Loss loss) {
  const SampsonModel model = ModelAt(matches, pose);
  SampsonSums sums;
  if (loss == Loss::kCauchy) {
    HWY_DYNAMIC_DISPATCH(SumCauchy)(matches, mask, model, &sums);
  } else {
    HWY_DYNAMIC_DISPATCH(SumSquared)(matches, mask, model, &sums);
  }
  return {sums.cost, Eigen::Map<const Vector5d>(sums.gradient), FromTriangle(sums.hessian)};
}

Matrix5d SampsonInformation(const MatchBlocks& matches, const MatchMask& mask, const RelativePose& pose) {
  double triangle[15];
  HWY_DYNAMIC_DISPATCH(SumInformation)(matches, mask, ModelAt(matches, pose), triangle);
  return FromTriangle(triangle);
}

}  // namespace rcme
#endif
