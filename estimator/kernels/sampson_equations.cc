#include "estimator/kernels/sampson_equations.h"

#include <algorithm>

#include "estimator/geometry/essential_matrix.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "estimator/kernels/sampson_equations.cc"
#include <hwy/foreach_target.h>
// The above must come before these.
#include "estimator/kernels/epipolar-inl.h"
#include "stats/portable_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

HWY_INLINE void AddTriangle(const Vec* a, Vec weight, Vec* sums) {
  for (int row = 0, i = 0; row < 5; ++row) {
    const Vec weighted = weight * a[row];
    for (int c = 0; c <= row; ++c, ++i) sums[i] = FusedMulAdd(weighted, a[c], sums[i]);
  }
}

// Calls visit(matches, constraint, 1 / n^2, w^2, b) for the matches `lane` to `lane` + kLanes - 1 of every
// block b, w their noise_scale and n = |J| w; 1 / n^2 is zero where unused.
template <bool are_scaled, typename Visit>
HWY_INLINE void ForEachBlock(const MatchBlocks& matches, const MatchMask& mask, const SampsonModel& model,
                             int lane, const Visit& visit) {
  for (int b = 0; b < matches.num_blocks(); ++b) {
    const Mask is_used = MaskFromBits(static_cast<unsigned>(mask[static_cast<size_t>(b)]) >> lane);
    const Matches m = LoadMatches(matches[b], lane);
    const Constraint c = EvaluateConstraint(Broadcast{model.F}, m);
    Vec noise2 = Set(1.0);
    if constexpr (are_scaled)
      noise2 = Square(Load(matches.noise_scales()[static_cast<size_t>(b)].scale + lane));
    const Vec n2 = hn::IfThenElse(is_used, Dot4(c.gradient, c.gradient) * noise2, Set(1.0));
    visit(m, c, hn::IfThenElseZero(is_used, Set(1.0) / n2), noise2, b);
  }
}

// sum log x of numbers 1 <= x <= 1e38, with one logarithm per eight blocks, b = 0, 1, ...
class LogSum {
 public:
  HWY_INLINE LogSum() : product_(Set(1.0)), sum_(Set(0.0)) {}
  HWY_INLINE void Add(Vec x, int b) {
    product_ = product_ * x;
    if (b % 8 == 7) Flush();
  }
  HWY_INLINE Vec Get() {
    Flush();
    return sum_;
  }

 private:
  HWY_INLINE void Flush() {
    sum_ = sum_ + ComputeLog(Tag(), product_);
    product_ = Set(1.0);
  }
  Vec product_, sum_;
};

// The eight partial sums of each of m numbers, one per lane of a block.
template <int m>
struct alignas(64) PartialSums {
  double lanes[m][kBlockSize];
  HWY_INLINE void Put(const Vec* sums, int lane) {
    for (int i = 0; i < m; ++i) Store(sums[i], lanes[i] + lane);
  }
  HWY_INLINE void Total(double* totals) const {
    for (int i = 0; i < m; ++i) totals[i] = SumOfEight(lanes[i]);
  }
};

// Sums of cost, gradient and Hessian over a lane's matches. With u = g / n^2 and e_k = g_k - g J'J_k / |J|^2:
// r^2 = g u, r dr/dp_k = u e_k, dr/dp_k dr/dp_l = e_k e_l / n^2. No root is needed.
template <Loss loss, bool are_scaled>
HWY_INLINE void SumLane(const MatchBlocks& matches, const MatchMask& mask, const SampsonModel& model,
                        int lane, Vec (&sums)[21]) {
  const Vec one = Set(1.0), inverse_c2 = Set(1.0 / (kCauchyScale * kCauchyScale));
  for (Vec& sum : sums) sum = Set(0.0);
  LogSum logs;
  ForEachBlock<are_scaled>(matches, mask, model, lane,
                           [&](const Matches& m, const Constraint& c, Vec inverse_n2, Vec noise2, int b) {
                             const Vec u = c.g * inverse_n2, r2 = c.g * u;
                             Vec e[5];
                             for (int k = 0; k < 5; ++k) {
                               const Constraint d = EvaluateConstraint(Broadcast{model.dF[k]}, m);
                               e[k] = FusedNegMulAdd(u * noise2, Dot4(c.gradient, d.gradient), d.g);
                             }
                             Vec weight = u, curvature = inverse_n2;
                             if constexpr (loss == Loss::kCauchy) {
                               // rho = c2 log(1 + r2 / c2), w = rho' = 1 / (1 + r2 / c2), psi' = 2 w^2 - w.
                               const Vec ratio = FusedMulAdd(r2, inverse_c2, one), w = one / ratio;
                               logs.Add(ratio, b);
                               weight = weight * w;
                               curvature = curvature * Greater(FusedMulSub(w + w, w, w), Set(0.7) * w);
                             } else {
                               sums[0] = sums[0] + r2;
                             }
                             for (int k = 0; k < 5; ++k) sums[1 + k] = FusedMulAdd(weight, e[k], sums[1 + k]);
                             AddTriangle(e, curvature, sums + 6);
                           });
  if constexpr (loss == Loss::kCauchy) sums[0] = logs.Get();
}

template <Loss loss, bool are_scaled>
HWY_INLINE void Sum(const MatchBlocks& matches, const MatchMask& mask, const SampsonModel& model,
                    SampsonSums* sums) {
  PartialSums<21> partial;
  for (int lane = 0; lane < kBlockSize; lane += kLanes) {
    Vec lane_sums[21];
    SumLane<loss, are_scaled>(matches, mask, model, lane, lane_sums);
    partial.Put(lane_sums, lane);
  }
  double totals[21];
  partial.Total(totals);
  sums->cost = totals[0] * (loss == Loss::kCauchy ? 0.5 * kCauchyScale * kCauchyScale : 0.5);
  std::copy(totals + 1, totals + 6, sums->gradient);
  std::copy(totals + 6, totals + 21, sums->hessian);
}

void SumSquared(const MatchBlocks& matches, const MatchMask& mask, const SampsonModel& model,
                SampsonSums* sums) {
  if (matches.noise_scales().empty()) return Sum<Loss::kSquared, false>(matches, mask, model, sums);
  Sum<Loss::kSquared, true>(matches, mask, model, sums);
}
void SumCauchy(const MatchBlocks& matches, const MatchMask& mask, const SampsonModel& model,
               SampsonSums* sums) {
  if (matches.noise_scales().empty()) return Sum<Loss::kCauchy, false>(matches, mask, model, sums);
  Sum<Loss::kCauchy, true>(matches, mask, model, sums);
}

template <bool are_scaled>
HWY_INLINE void SumInformationOver(const MatchBlocks& matches, const MatchMask& mask,
                                   const SampsonModel& model, double* triangle) {
  PartialSums<15> partial;
  for (int lane = 0; lane < kBlockSize; lane += kLanes) {
    Vec information[15];
    for (Vec& sum : information) sum = Set(0.0);
    ForEachBlock<are_scaled>(matches, mask, model, lane,
                             [&](const Matches& m, const Constraint&, Vec inverse_n2, Vec, int) {
                               Vec g_p[5];
                               for (int k = 0; k < 5; ++k)
                                 g_p[k] = EvaluateConstraint(Broadcast{model.dF[k]}, m).g;
                               AddTriangle(g_p, inverse_n2, information);
                             });
    partial.Put(information, lane);
  }
  partial.Total(triangle);
}

void SumInformation(const MatchBlocks& matches, const MatchMask& mask, const SampsonModel& model,
                    double* triangle) {
  if (matches.noise_scales().empty()) return SumInformationOver<false>(matches, mask, model, triangle);
  SumInformationOver<true>(matches, mask, model, triangle);
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

RefinedMotion RefineBySampson(const MatchBlocks& matches, const MatchMask& mask, const RelativePose& start,
                              Loss loss) {
  const SampsonEquations equations{
      CountIn(mask),
      [&](const RelativePose& pose, Loss rho) { return LinearizeSampson(matches, mask, pose, rho); },
      [&](const RelativePose& pose) { return SampsonInformation(matches, mask, pose); }};
  return RefineBySampson(equations, start, loss);
}

}  // namespace rcme
#endif
