#include "estimator/kernels/hypothesis_block.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "estimator/kernels/hypothesis_block.cc"
#include <hwy/foreach_target.h>
// The above must come before these.
#include "estimator/kernels/essential_projection-inl.h"
#include "estimator/kernels/hypothesis_lanes-inl.h"
#include "estimator/kernels/lanes-inl.h"
#include "estimator/kernels/null_vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

// Sigma_p (eq::cov_p) and the misfit's covariance from Sigma_f (eq. 6), without forming Sigma_f. Three
// products of the projection complete the basis T of the motions (hypothesis_lanes-inl.h). They span the
// directions normal to the essential matrices:
//
//   N = (u1 v1' - u2 v2') / sqrt(2), (u1 v2' + u2 v1') / sqrt(2), u3 v3'
//
// With delta f = -G n and var n = D, the covariance of the coordinates of delta f is (G'b_i)' D (G'b_j).
HWY_INLINE void NormalBasis(const EssentialBasis& e, Vec (&N)[3][9]) {
  const Vec root_half = Set(0.70710678118654752440);
  const Vec3 u1 = Times(e.u[0], root_half), u2 = Times(e.u[1], root_half);
  SumOfProducts(u1, e.v[0], Times(u2, Set(-1.0)), e.v[1], N[0]);
  SumOfProducts(u1, e.v[1], u2, e.v[0], N[1]);
  Product(e.u[2], e.v[2], N[2]);
}

// Lower Cholesky factor of an m x m matrix (lower triangle). Pivots that rounding made negative count as 0.
template <int m>
HWY_INLINE void Cholesky(const Vec (&S)[m][m], Vec (&L)[m][m]) {
  // First S = L1 diag(pivots) L1', scaled = L1 diag(pivots): no root in the long chain.
  Vec pivots[m], scaled[m][m];
  for (int j = 0; j < m; ++j) {
    Vec pivot = S[j][j];
    for (int k = 0; k < j; ++k) pivot = FusedNegMulAdd(scaled[j][k], L[j][k], pivot);
    const Mask is_positive = pivot > Set(0.0);
    pivots[j] = hn::IfThenElseZero(is_positive, pivot);
    const Vec inverse = hn::IfThenElseZero(is_positive, Set(1.0) / pivot);
    for (int i = j + 1; i < m; ++i) {
      Vec rest = S[i][j];
      for (int k = 0; k < j; ++k) rest = FusedNegMulAdd(scaled[i][k], L[j][k], rest);
      scaled[i][j] = rest;
      L[i][j] = rest * inverse;
    }
  }
  for (int j = 0; j < m; ++j) {
    L[j][j] = hn::Sqrt(pivots[j]);
    for (int i = j + 1; i < m; ++i) L[i][j] = L[i][j] * L[j][j];
  }
}

// m' C^-1 m of a 3x3 C (lower triangle); infinite unless C is positive definite.
HWY_INLINE Vec SquaredMahalanobis(const Vec* m, const Vec (&C)[3][3]) {
  const Vec inverse0 = Set(1.0) / C[0][0];
  const Vec l10 = C[1][0] * inverse0, l20 = C[2][0] * inverse0;
  const Vec d1 = FusedNegMulAdd(l10, C[1][0], C[1][1]), inverse1 = Set(1.0) / d1;
  const Vec s21 = FusedNegMulAdd(l10, C[2][0], C[2][1]), l21 = s21 * inverse1;
  const Vec d2 = FusedNegMulAdd(l21, s21, FusedNegMulAdd(l20, C[2][0], C[2][2]));
  const Vec m1 = FusedNegMulAdd(l10, m[0], m[1]);
  const Vec m2 = FusedNegMulAdd(l21, m1, FusedNegMulAdd(l20, m[0], m[2]));
  const Vec squared = Square(m[0]) * inverse0 + Square(m1) * inverse1 + Square(m2) / d2;
  const Mask is_definite = Lesser(C[0][0], Lesser(d1, d2)) > Set(0.0);
  return hn::IfThenElse(is_definite, squared, Set(std::numeric_limits<double>::infinity()));
}

// Covariance of the coordinates of delta f along m vectors b: (G'b_i)' D (G'b_j), lower triangle. Overwrites
// b.
template <int m>
HWY_INLINE void PropagateCovariance(const ConstraintFactors& factors, const Vec* D, Vec (&b)[m][9],
                                    Vec (&cov)[m][m]) {
  Vec gain[m][8];
  ApplyGainTransposed(factors, b, gain);
  for (int row = 0; row < m; ++row) {
    Vec scaled[8];
    for (int k = 0; k < 8; ++k) scaled[k] = D[k] * gain[row][k];
    for (int c = 0; c <= row; ++c) {
      Vec even = scaled[0] * gain[c][0], odd = scaled[1] * gain[c][1];
      for (int k = 2; k < 8; k += 2) {
        even = FusedMulAdd(scaled[k], gain[c][k], even);
        odd = FusedMulAdd(scaled[k + 1], gain[c][k + 1], odd);
      }
      cov[row][c] = even + odd;
    }
  }
}

// Fills dF of some lanes. Returns the lanes whose dF is finite.
HWY_INLINE Mask FillDerivatives(const ConstraintFactors& factors, const EssentialBasis& basis, const Vec* D,
                                const Whitening& whitening, int lane, HypothesisBlock* block) {
  Vec T[5][9], cov[5][5], L[5][5];
  MotionBasis(basis, T);
  PropagateCovariance(factors, D, T, cov);
  Cholesky(cov, L);
  Vec trace = Set(0.0);
  for (int k = 0; k < 5; ++k) {
    Vec l[5];
    for (int c = 0; c < 5; ++c) l[c] = c < k ? Set(0.0) : L[c][k];
    Mat3 dE;
    Derivative(basis, l, &dE);
    StoreWhitened(dE, whitening, lane, block->dF[k]);
    trace = trace + cov[k][k];
  }
  return hn::IsFinite(trace);
}

// The statistic of the joint test of a sample (eq::sample-p-test).
HWY_INLINE void FillSampleStatistic(const ConstraintFactors& factors, const EssentialBasis& basis,
                                    const Vec* D, int lane, HypothesisBlock* block) {
  Vec N[3][9], cov[3][3];
  NormalBasis(basis, N);
  PropagateCovariance(factors, D, N, cov);
  Store(SquaredMahalanobis(basis.misfit, cov), block->sample_statistic + lane);
}

// Fills lanes [lane, lane + kLanes) of the block: f (eq::model_instantiate), its motion
// (eq::motion_estimate), and the numbers that `outputs` requests.
template <RequestedOutputs outputs>
HWY_INLINE Mask FillLanes(const Whitening& whitening, int lane, HypothesisBlock* block) {
  const SampleLanes<8> sample(*block, lane);
  ConstraintFactors factors;
  FillConstraints(sample, whitening, factors.columns);
  Factor(factors);
  Vec f[9];
  NullVector(factors, f);
  const EssentialBasis basis =
      ProjectToEssential({{{f[0], f[1], f[2]}, {f[3], f[4], f[5]}, {f[6], f[7], f[8]}}});
  const auto row = [&](Vec a, Vec b) { return Combine(basis.v[0], a, basis.v[1], b); };
  StoreWhitened(
      {{row(basis.u[0].x, basis.u[1].x), row(basis.u[0].y, basis.u[1].y), row(basis.u[0].z, basis.u[1].z)}},
      whitening, lane, block->F);
  const Mask is_model =
      hn::And(factors.smallest_pivot > Set(1e-9) * factors.largest_pivot, basis.determines_direction);
  if constexpr (outputs == RequestedOutputs::kNone) return is_model;
  Vec D[8];
  ConstraintVariances(sample, whitening, f, D);
  if constexpr (outputs == RequestedOutputs::kCovarianceAndMisfit) {
    FillSampleStatistic(factors, basis, D, lane, block);
  }
  return hn::And(is_model, FillDerivatives(factors, basis, D, whitening, lane, block));
}

template <RequestedOutputs outputs>
void FillBlock(const RayScale& ray_scale, HypothesisBlock* block) {
  const Whitening whitening(ray_scale);
  unsigned is_model = 0;
  for (int lane = 0; lane < kBlockSize; lane += kLanes) {
    is_model |= ReadMaskBits(FillLanes<outputs>(whitening, lane, block)) << lane;
  }
  block->is_model = static_cast<std::uint8_t>(is_model);
}

void FillModels(const RayScale& ray_scale, HypothesisBlock* block) {
  FillBlock<RequestedOutputs::kNone>(ray_scale, block);
}
void FillUncertainModels(const RayScale& ray_scale, HypothesisBlock* block) {
  FillBlock<RequestedOutputs::kCovariance>(ray_scale, block);
}
void FillTestedModels(const RayScale& ray_scale, HypothesisBlock* block) {
  FillBlock<RequestedOutputs::kCovarianceAndMisfit>(ray_scale, block);
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rcme {

HWY_EXPORT(FillModels);
HWY_EXPORT(FillUncertainModels);
HWY_EXPORT(FillTestedModels);

void CopySample(const MatchBlocks& matches, const Sample& sample, int hypothesis, HypothesisBlock* block) {
  for (size_t k = 0; k < static_cast<size_t>(sample.size()); ++k) {
    const int lane = sample[k] % kBlockSize;
    const MatchBlock& from = matches[sample[k] / kBlockSize];
    block->x1[k][hypothesis] = from.x1[lane];
    block->y1[k][hypothesis] = from.y1[lane];
    block->x2[k][hypothesis] = from.x2[lane];
    block->y2[k][hypothesis] = from.y2[lane];
  }
}

void InstantiateModels(const MatchBlocks& matches, std::span<const Sample, kBlockSize> samples,
                       RequestedOutputs outputs, HypothesisBlock* block) {
  for (int hypothesis = 0; hypothesis < kBlockSize; ++hypothesis) {
    CopySample(matches, samples[static_cast<size_t>(hypothesis)], hypothesis, block);
  }
  switch (outputs) {
    case RequestedOutputs::kNone:
      return HWY_DYNAMIC_DISPATCH(FillModels)(matches.ray_scale(), block);
    case RequestedOutputs::kCovariance:
      return HWY_DYNAMIC_DISPATCH(FillUncertainModels)(matches.ray_scale(), block);
    case RequestedOutputs::kCovarianceAndMisfit:
      return HWY_DYNAMIC_DISPATCH(FillTestedModels)(matches.ray_scale(), block);
  }
}

}  // namespace rcme
#endif
