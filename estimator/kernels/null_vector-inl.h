// Householder factorization of M' (9x8, one column per constraint) for several samples side by side: M' = Q
// R, Q = H_0 H_1 ... H_7, H_k = I + tau_k v_k v_k' with v_k zero above row k. The last column of Q is f, the
// null vector of M. The first eight columns are A, and M A = R1' (R1: the upper 8x8 of R).
//
// Let x be the rest of column k, alpha = -sign(x_0) |x| and v = x - alpha e_0. Then H x = alpha e_0 for
// tau = -2 / v'v = 1 / (alpha v_0).
#if defined(RCME_ESTIMATOR_KERNELS_NULL_VECTOR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RCME_ESTIMATOR_KERNELS_NULL_VECTOR_INL_H_
#undef RCME_ESTIMATOR_KERNELS_NULL_VECTOR_INL_H_
#else
#define RCME_ESTIMATOR_KERNELS_NULL_VECTOR_INL_H_
#endif

#include <utility>

#include "estimator/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

struct ConstraintFactors {
  Vec columns[8][9];  // M' on entry; then v_k from row k on, R above
  Vec tau[8];
  Vec inverse_pivot[8];               // 1 / R_kk
  Vec smallest_pivot, largest_pivot;  // of |R_kk|
};

// sum of a_i b_i, i = k..8, in three chains, because a single one would wait for its own results.
template <int k>
HWY_INLINE Vec DotFrom(const Vec* a, const Vec* b) {
  Vec sums[3] = {Set(0.0), Set(0.0), a[8] * b[8]};
  for (int i = 7; i >= k; --i) sums[i % 3] = FusedMulAdd(a[i], b[i], sums[i % 3]);
  return (sums[0] + sums[1]) + sums[2];
}

// b + tau_k v_k (v_k' b): H_k b.
template <int k>
HWY_INLINE void Reflect(const Vec* v, Vec tau, Vec* b) {
  const Vec weight = tau * DotFrom<k>(v, b);
  for (int i = k; i < 9; ++i) b[i] = FusedMulAdd(v[i], weight, b[i]);
}

// The same for m vectors: first all sums, then all updates.
template <int k, int m>
HWY_INLINE void ReflectAll(const Vec* v, Vec tau, Vec (&b)[m][9]) {
  Vec weights[m];
  for (int i = 0; i < m; ++i) weights[i] = tau * DotFrom<k>(v, b[i]);
  for (int row = k; row < 9; ++row) {
    for (int i = 0; i < m; ++i) b[i][row] = FusedMulAdd(v[row], weights[i], b[i][row]);
  }
}

template <int k>
HWY_INLINE void FactorColumn(ConstraintFactors& factors) {
  Vec* x = factors.columns[k];
  const Vec norm = hn::Sqrt(DotFrom<k>(x, x));
  const Vec alpha = hn::CopySign(norm, hn::Neg(x[k]));
  const Vec v_0 = x[k] - alpha;
  factors.tau[k] = Set(1.0) / (alpha * v_0);
  factors.inverse_pivot[k] = factors.tau[k] * v_0;
  factors.smallest_pivot = k == 0 ? norm : Lesser(norm, factors.smallest_pivot);
  factors.largest_pivot = k == 0 ? norm : Greater(norm, factors.largest_pivot);
  x[k] = v_0;
  for (int c = k + 1; c < 8; ++c) Reflect<k>(x, factors.tau[k], factors.columns[c]);
}

HWY_INLINE void Factor(ConstraintFactors& factors) {
  [&]<int... k>(std::integer_sequence<int, k...>) { (FactorColumn<k>(factors), ...); }
  (std::make_integer_sequence<int, 8>());
}

// f, the last column of Q (eq::model_instantiate).
HWY_INLINE void NullVector(const ConstraintFactors& factors, Vec* f) {
  for (int i = 0; i < 8; ++i) f[i] = Set(0.0);
  f[8] = Set(1.0);
  [&]<int... k>(std::integer_sequence<int, k...>) {
    (Reflect<7 - k>(factors.columns[7 - k], factors.tau[7 - k], f), ...);
  }
  (std::make_integer_sequence<int, 8>());
}

// G'b (8 numbers each) for m 9-vectors b, which are overwritten: the solution y of R1 y = (Q'b)_top, where
// G = A R1^-T and Sigma_f = G D G' (eq. 6). All are computed side by side, because each alone is one long
// chain of dependent operations.
template <int m>
HWY_INLINE void ApplyGainTransposed(const ConstraintFactors& factors, Vec (&b)[m][9], Vec (*y)[8]) {
  [&]<int... k>(std::integer_sequence<int, k...>) {
    (ReflectAll<k>(factors.columns[k], factors.tau[k], b), ...);
  }
  (std::make_integer_sequence<int, 8>());
  for (int row = 7; row >= 0; --row) {
    for (int i = 0; i < m; ++i) {
      Vec rest = b[i][row];
      for (int c = row + 1; c < 8; ++c) rest = FusedNegMulAdd(factors.columns[c][row], y[i][c], rest);
      y[i][row] = rest * factors.inverse_pivot[row];
    }
  }
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
