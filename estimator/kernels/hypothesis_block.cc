#include "estimator/kernels/hypothesis_block.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "estimator/kernels/hypothesis_block.cc"
#include <hwy/foreach_target.h>
// The above must come before these.
#include "estimator/kernels/essential_projection-inl.h"
#include "estimator/kernels/lanes-inl.h"
#include "estimator/kernels/null_vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

// Sigma_p (eq::cov_p) and the misfit's covariance from Sigma_f (eq. 6), without forming Sigma_f.
//
// The products u_i v_j' of the projection are an orthonormal basis of the 3x3 matrices. Five of them (and
// combinations) span the motions, three what is normal to the essential matrices, one is E itself:
//
//   T = (u1 v2' - u2 v1') / sqrt(2), u3 v1', u3 v2', u1 v3', u2 v3'
//   N = (u1 v1' - u2 v2') / sqrt(2), (u1 v2' + u2 v1') / sqrt(2), u3 v3'
//
// With delta f = -G n and var n = D, the covariance of the coordinates of delta f is (G'b_i)' D (G'b_j).
HWY_INLINE void Product(const Vec3& u, const Vec3& v, Vec* b) {
  const Vec us[] = {u.x, u.y, u.z};
  for (int i = 0; i < 3; ++i) {
    b[3 * i] = us[i] * v.x;
    b[3 * i + 1] = us[i] * v.y;
    b[3 * i + 2] = us[i] * v.z;
  }
}
HWY_INLINE void SumOfProducts(const Vec3& u, const Vec3& v, const Vec3& s, const Vec3& r, Vec* b) {
  Product(u, v, b);
  const Vec ss[] = {s.x, s.y, s.z};
  for (int i = 0; i < 3; ++i) {
    b[3 * i] = FusedMulAdd(ss[i], r.x, b[3 * i]);
    b[3 * i + 1] = FusedMulAdd(ss[i], r.y, b[3 * i + 1]);
    b[3 * i + 2] = FusedMulAdd(ss[i], r.z, b[3 * i + 2]);
  }
}

HWY_INLINE void MotionBasis(const EssentialBasis& e, Vec (&T)[5][9]) {
  const Vec root_half = Set(0.70710678118654752440);
  SumOfProducts(Times(e.u[0], root_half), e.v[1], Times(e.u[1], hn::Neg(root_half)), e.v[0], T[0]);
  Product(e.u[2], e.v[0], T[1]);
  Product(e.u[2], e.v[1], T[2]);
  Product(e.u[0], e.v[2], T[3]);
  Product(e.u[1], e.v[2], T[4]);
}

HWY_INLINE void NormalBasis(const EssentialBasis& e, Vec (&N)[3][9]) {
  const Vec root_half = Set(0.70710678118654752440);
  const Vec3 u1 = Times(e.u[0], root_half), u2 = Times(e.u[1], root_half);
  SumOfProducts(u1, e.v[0], Times(u2, Set(-1.0)), e.v[1], N[0]);
  SumOfProducts(u1, e.v[1], u2, e.v[0], N[1]);
  Product(e.u[2], e.v[2], N[2]);
}

// Lower Cholesky factor of an m x m matrix (lower triangle); a pivot that rounding made negative counts as 0.
template <int m>
HWY_INLINE void Cholesky(const Vec (&S)[m][m], Vec (&L)[m][m]) {
  Vec pivots[m],
      scaled[m][m];  // S = L1 diag(pivots) L1' first, scaled = L1 diag(pivots): no root on the long chain
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

// The eight samples of some lanes of a block.
struct SampleLanes {
  Vec x1[8], y1[8], x2[8], y2[8];
};

// Matrices in rays to whitened coordinates: entry (i, j) times second[i] first[j].
struct Whitening {
  Vec first[3], second[3];
  explicit Whitening(const RayScale& s)
      : first{Set(s.x1), Set(s.y1), Set(1.0)}, second{Set(s.x2), Set(s.y2), Set(1.0)} {}
  Vec operator()(int i, int j, Vec entry) const { return entry * (second[i] * first[j]); }
};

HWY_INLINE void FillConstraints(const SampleLanes& sample, const Whitening& whitening, Vec (&columns)[8][9]) {
  for (int k = 0; k < 8; ++k) {
    const Vec ray1[] = {sample.x1[k] * whitening.first[0], sample.y1[k] * whitening.first[1]};
    const Vec ray2[] = {sample.x2[k] * whitening.second[0], sample.y2[k] * whitening.second[1]};
    Vec* column = columns[k];
    for (int i = 0; i < 2; ++i) {
      column[3 * i] = ray2[i] * ray1[0];
      column[3 * i + 1] = ray2[i] * ray1[1];
      column[3 * i + 2] = ray2[i];
      column[6 + i] = ray1[i];
    }
    column[8] = Set(1.0);
  }
}

// D_k = |J|^2 of the sample's constraints under the linear model f.
HWY_INLINE void ConstraintVariances(const SampleLanes& sample, const Whitening& whitening, const Vec* f,
                                    Vec* D) {
  Vec F[9];
  for (int i = 0; i < 9; ++i) F[i] = whitening(i / 3, i % 3, f[i]);
  for (int k = 0; k < 8; ++k) {
    const Vec in_2_x = FusedMulAdd(F[0], sample.x1[k], FusedMulAdd(F[1], sample.y1[k], F[2]));
    const Vec in_2_y = FusedMulAdd(F[3], sample.x1[k], FusedMulAdd(F[4], sample.y1[k], F[5]));
    const Vec in_1_x = FusedMulAdd(F[0], sample.x2[k], FusedMulAdd(F[3], sample.y2[k], F[6]));
    const Vec in_1_y = FusedMulAdd(F[1], sample.x2[k], FusedMulAdd(F[4], sample.y2[k], F[7]));
    D[k] = FusedMulAdd(in_2_x, in_2_x,
                       FusedMulAdd(in_2_y, in_2_y, FusedMulAdd(in_1_x, in_1_x, in_1_y * in_1_y)));
  }
}

// Covariance of the coordinates of delta f in m vectors b, which are overwritten: (G'b_i)' D (G'b_j), lower
// triangle.
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

// dE along a principal axis with coordinates l in T: with |E|^2 = 2, sqrt(2) sum_c l_c T_c.
HWY_INLINE void Derivative(const EssentialBasis& e, const Vec* l, Mat3* dE) {
  const Vec root_two = Set(1.41421356237309504880);
  const Vec turn = l[0], l1 = root_two * l[1], l2 = root_two * l[2], l3 = root_two * l[3],
            l4 = root_two * l[4];
  // Rows in the basis v: u1 (turn v2 + l3 v3), u2 (-turn v1 + l4 v3), u3 (l1 v1 + l2 v2).
  const Vec3 along1 = Combine(e.v[1], turn, e.v[2], l3);
  const Vec3 along2 = Combine(e.v[0], hn::Neg(turn), e.v[2], l4);
  const Vec3 along3 = Combine(e.v[0], l1, e.v[1], l2);
  const Mat3 u = {{e.u[0], e.u[1], e.u[2]}};
  const auto row = [&](Vec a, Vec b, Vec c) {
    const Vec3 two = Combine(along1, a, along2, b);
    return Vec3{FusedMulAdd(along3.x, c, two.x), FusedMulAdd(along3.y, c, two.y),
                FusedMulAdd(along3.z, c, two.z)};
  };
  dE->row[0] = row(u.row[0].x, u.row[1].x, u.row[2].x);
  dE->row[1] = row(u.row[0].y, u.row[1].y, u.row[2].y);
  dE->row[2] = row(u.row[0].z, u.row[1].z, u.row[2].z);
}

HWY_INLINE void StoreWhitened(const Mat3& E, const Whitening& whitening, int lane, HypothesisBlock::Row* F) {
  for (int i = 0; i < 3; ++i) {
    Store(whitening(i, 0, E.row[i].x), &F[3 * i][lane]);
    Store(whitening(i, 1, E.row[i].y), &F[3 * i + 1][lane]);
    Store(whitening(i, 2, E.row[i].z), &F[3 * i + 2][lane]);
  }
}

// dF of some lanes; returns where they are finite.
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

HWY_INLINE void FillSampleStatistic(const ConstraintFactors& factors, const EssentialBasis& basis,
                                    const Vec* D, int lane, HypothesisBlock* block) {
  Vec N[3][9], cov[3][3];
  NormalBasis(basis, N);
  PropagateCovariance(factors, D, N, cov);
  Store(SquaredMahalanobis(basis.misfit, cov), block->sample_statistic + lane);
}

// Lanes [lane, lane + kLanes) of the block.
template <Spread spread>
HWY_INLINE Mask FillLanes(const Whitening& whitening, int lane, HypothesisBlock* block) {
  SampleLanes sample;
  for (int k = 0; k < 8; ++k) {
    sample.x1[k] = Load(block->x1[k] + lane);
    sample.y1[k] = Load(block->y1[k] + lane);
    sample.x2[k] = Load(block->x2[k] + lane);
    sample.y2[k] = Load(block->y2[k] + lane);
  }
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
  if constexpr (spread == Spread::kNone) return is_model;
  Vec D[8];
  ConstraintVariances(sample, whitening, f, D);
  if constexpr (spread == Spread::kCovarianceAndMisfit) {
    FillSampleStatistic(factors, basis, D, lane, block);
  }
  return hn::And(is_model, FillDerivatives(factors, basis, D, whitening, lane, block));
}

template <Spread spread>
void FillBlock(const RayScale& ray_scale, HypothesisBlock* block) {
  const Whitening whitening(ray_scale);
  unsigned is_model = 0;
  for (int lane = 0; lane < kBlockSize; lane += kLanes) {
    is_model |= BitsOf(FillLanes<spread>(whitening, lane, block)) << lane;
  }
  block->is_model = static_cast<std::uint8_t>(is_model);
}

void FillModels(const RayScale& ray_scale, HypothesisBlock* block) {
  FillBlock<Spread::kNone>(ray_scale, block);
}
void FillUncertainModels(const RayScale& ray_scale, HypothesisBlock* block) {
  FillBlock<Spread::kCovariance>(ray_scale, block);
}
void FillTestedModels(const RayScale& ray_scale, HypothesisBlock* block) {
  FillBlock<Spread::kCovarianceAndMisfit>(ray_scale, block);
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rcme {

HWY_EXPORT(FillModels);
HWY_EXPORT(FillUncertainModels);
HWY_EXPORT(FillTestedModels);

void InstantiateModels(const MatchBlocks& matches, std::span<const Sample, kBlockSize> samples, Spread spread,
                       HypothesisBlock* block) {
  for (size_t hypothesis = 0; hypothesis < samples.size(); ++hypothesis) {
    for (size_t k = 0; k < samples[hypothesis].size(); ++k) {
      const int index = samples[hypothesis][k], lane = index % kBlockSize;
      const MatchBlock& from = matches[index / kBlockSize];
      block->x1[k][hypothesis] = from.x1[lane];
      block->y1[k][hypothesis] = from.y1[lane];
      block->x2[k][hypothesis] = from.x2[lane];
      block->y2[k][hypothesis] = from.y2[lane];
    }
  }
  switch (spread) {
    case Spread::kNone:
      return HWY_DYNAMIC_DISPATCH(FillModels)(matches.ray_scale(), block);
    case Spread::kCovariance:
      return HWY_DYNAMIC_DISPATCH(FillUncertainModels)(matches.ray_scale(), block);
    case Spread::kCovarianceAndMisfit:
      return HWY_DYNAMIC_DISPATCH(FillTestedModels)(matches.ray_scale(), block);
  }
}

}  // namespace rcme
#endif
