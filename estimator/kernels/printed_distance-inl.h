// The point test as printed (eq::find-inlier): delta' Sigma_delta^-1 delta (eq::mahalanobis_dist_F) with
// Sigma_delta 4x4 (eq::cov_sampson_error_vec), in closed form.
//
// In whitened coordinates (unit noise) let g be the value of the constraint, j its gradient, n2 = |j|^2, H
// its Hessian, and g_k, j_k the value and gradient of its derivatives along the principal axes of the motion.
// The Sampson vector -j g / n2 (eq::sampson_error_vec) depends on match and motion only through z = (j, g),
// whose covariance is
//
//   X = [[Q, a], [a', D]],   Q = H H' + sum j_k j_k',   a = H j + sum g_k j_k,   D = n2 + sum g_k^2.
//
// Up to a reflection, n2^2 Sigma_delta = B X B' with B = [g I, -j], whose null vector is z. For such a B
// (Cauchy-Binet) det(B X B') = g^6 det(X) z' X^-1 z, and by blocks, with e = D - a'Q^-1 a,
//
//   det(X) z'X^-1 z = det(Q) p,   p = e j'Q^-1 j + (g - a'Q^-1 j)^2.
//
// The same argument one dimension lower gives the quadratic form. Hence
//
//   d2 = g^2 j'Q^-1 j / p,   det Sigma_delta = g^6 det(Q) p / n2^8.
//
// There is no division by g. Q is factored as L diag(d) L'. Cofactors, or 2x2 blocks and their inverses,
// would be cheaper but lose digits, because the eigenvalues of Q span many decades.
#if defined(RCME_ESTIMATOR_KERNELS_PRINTED_DISTANCE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RCME_ESTIMATOR_KERNELS_PRINTED_DISTANCE_INL_H_
#undef RCME_ESTIMATOR_KERNELS_PRINTED_DISTANCE_INL_H_
#else
#define RCME_ESTIMATOR_KERNELS_PRINTED_DISTANCE_INL_H_
#endif

#include "estimator/kernels/epipolar-inl.h"
#include "estimator/point_consistency.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

struct PrintedDistance {
  Vec numerator, denominator;  // d2 = numerator / denominator
  Mask is_regular;             // Sigma_delta is positive definite
  Vec determinant;             // of Sigma_delta, in units of sigma^8
};

// Lower triangle of a symmetric 4x4 matrix, row by row: 00, 10, 11, 20, 21, 22, 30, 31, 32, 33.
HWY_INLINE void AddOuterProduct(const Vec* j, Vec* Q) {
  for (int row = 0, i = 0; row < 4; ++row) {
    for (int c = 0; c <= row; ++c, ++i) Q[i] = FusedMulAdd(j[row], j[c], Q[i]);
  }
}

// Model: F(i) and dF(k) as Entries of EvaluateConstraint.
template <typename Model>
HWY_INLINE PrintedDistance EvaluatePrinted(const Model& model, const Matches& matches) {
  const Constraint c = EvaluateConstraint(model.F(), matches);
  const Vec* j = c.gradient;
  const Vec n2 = Dot4(j, j);

  // H = [[0, A'], [A, 0]], A the upper left 2x2 of F: H H' = [[A'A, 0], [0, A A']].
  const Vec A00 = model.F()(0), A01 = model.F()(1), A10 = model.F()(3), A11 = model.F()(4), zero = Set(0.0);
  Vec Q[10] = {FusedMulAdd(A00, A00, A10 * A10),
               FusedMulAdd(A00, A01, A10 * A11),
               FusedMulAdd(A01, A01, A11 * A11),
               zero,
               zero,
               FusedMulAdd(A00, A00, A01 * A01),
               zero,
               zero,
               FusedMulAdd(A00, A10, A01 * A11),
               FusedMulAdd(A10, A10, A11 * A11)};
  Vec a[4] = {FusedMulAdd(A00, j[2], A10 * j[3]), FusedMulAdd(A01, j[2], A11 * j[3]),
              FusedMulAdd(A00, j[0], A01 * j[1]), FusedMulAdd(A10, j[0], A11 * j[1])};
  Vec D = n2;
#pragma GCC unroll 5
  for (int k = 0; k < 5; ++k) {
    const Constraint d = EvaluateConstraint(model.dF(k), matches);
    AddOuterProduct(d.gradient, Q);
    for (int i = 0; i < 4; ++i) a[i] = FusedMulAdd(d.g, d.gradient[i], a[i]);
    D = FusedMulAdd(d.g, d.g, D);
  }

  // Q = L diag(d) L', y = L^-1 j, b = L^-1 a; i_k = 1 / d_k. The second and fourth pivot are ratios of
  // minors, so that two divisions run at a time.
  const Vec one = Set(1.0);
  const Vec d0 = Q[0], minor1 = FusedMulSub(Q[0], Q[2], Q[1] * Q[1]), i0 = one / d0, i1 = d0 * (one / minor1);
  const Vec l10 = Q[1] * i0, l20 = Q[3] * i0, l30 = Q[6] * i0;
  const Vec s21 = FusedNegMulAdd(l10, Q[3], Q[4]), s31 = FusedNegMulAdd(l10, Q[6], Q[7]);
  const Vec l21 = s21 * i1, l31 = s31 * i1;
  const Vec d2 = FusedNegMulAdd(l21, s21, FusedNegMulAdd(l20, Q[3], Q[5]));
  const Vec s32 = FusedNegMulAdd(l21, s31, FusedNegMulAdd(l20, Q[6], Q[8]));
  const Vec s33 = FusedNegMulAdd(l31, s31, FusedNegMulAdd(l30, Q[6], Q[9]));
  const Vec minor3 = FusedMulSub(d2, s33, s32 * s32), i2 = one / d2, i3 = d2 * (one / minor3), l32 = s32 * i2;
  const auto solve = [&](const Vec* x, Vec* y) {
    y[0] = x[0];
    y[1] = FusedNegMulAdd(l10, y[0], x[1]);
    y[2] = FusedNegMulAdd(l21, y[1], FusedNegMulAdd(l20, y[0], x[2]));
    y[3] = FusedNegMulAdd(l32, y[2], FusedNegMulAdd(l31, y[1], FusedNegMulAdd(l30, y[0], x[3])));
  };
  Vec y[4], b[4];
  solve(j, y);
  solve(a, b);
  const Vec iy[4] = {i0 * y[0], i1 * y[1], i2 * y[2], i3 * y[3]};
  const Vec ib[4] = {i0 * b[0], i1 * b[1], i2 * b[2], i3 * b[3]};
  const Vec jQj = Dot4(iy, y), rest = c.g - Dot4(iy, b), e = D - Dot4(ib, b);
  const Vec p = FusedMulAdd(e, jQj, rest * rest);

  const Vec g2 = c.g * c.g, unit = one / n2, unit2 = unit * unit;
  const Vec squared_distance = Greater(g2 * unit, Set(kLeastSquaredDistance));
  PrintedDistance distance;
  distance.numerator = g2 * jQj;
  distance.denominator = p;
  distance.is_regular = hn::And(Lesser(Lesser(d0, minor1), Lesser(d2, minor3)) > zero, p > zero);
  distance.determinant = squared_distance * squared_distance * squared_distance *
                         ((minor1 * unit2) * (minor3 * unit2)) * (p * unit);
  return distance;
}

// Whether d2 <= threshold, for a match (eq::find-inlier) or for a sample's own matches (eq. 12).
HWY_INLINE Mask IsWithin(const PrintedDistance& distance, Vec threshold) {
  return hn::And(distance.numerator <= threshold * distance.denominator, distance.is_regular);
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
