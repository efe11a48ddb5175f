// The polynomial of degree ten whose real roots are the essential matrices through five matches (Nister
// 2004), for several samples side by side. Three combinations of the last six eliminated rows leave
//
//   B(z) (x, y, 1)' = 0,   B 3x3 with columns of degree 3, 3, 4 in z (w = 1),   p(z) = det B(z).
#if defined(RCME_ESTIMATOR_KERNELS_FIVE_POINT_POLYNOMIAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RCME_ESTIMATOR_KERNELS_FIVE_POINT_POLYNOMIAL_INL_H_
#undef RCME_ESTIMATOR_KERNELS_FIVE_POINT_POLYNOMIAL_INL_H_
#else
#define RCME_ESTIMATOR_KERNELS_FIVE_POINT_POLYNOMIAL_INL_H_
#endif

#include "estimator/kernels/five_point_block.h"
#include "estimator/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

constexpr int kDegree = 10;

// The polynomials of eight samples, as the search for roots needs them; index [number][sample].
struct alignas(64) BlockPolynomials {
  using Row = double[kBlockSize];
  Row p[kDegree + 1];  // ascending powers
  Row B[3][13];        // in each row the coefficients of x (4), y (4), 1 (5)
  Row basis[9][4];     // NullSpace::E
};

// A row of B(z): the coefficients of x, y and 1, each in ascending powers of z.
struct PolynomialRow {
  Vec x[4], y[4], one[5];
};

// with_z - z without_z. The rows hold ten coefficients (of xzz ... www); they were solved for the same
// monomial times z and times 1.
HWY_INLINE PolynomialRow MakeRow(const double (*with_z)[kLanes], const double (*without_z)[kLanes]) {
  const auto e = [&](int c) { return Load(with_z[c]); };
  const auto f = [&](int c) { return Load(without_z[c]); };
  return {{e(2), e(1) - f(2), e(0) - f(1), hn::Neg(f(0))},
          {e(5), e(4) - f(5), e(3) - f(4), hn::Neg(f(3))},
          {e(9), e(8) - f(9), e(7) - f(8), e(6) - f(7), hn::Neg(f(6))}};
}

// det B(z) in ascending powers, expanded along the column of 1.
HWY_INLINE void Determinant(const PolynomialRow (&B)[3], Vec (&p)[kDegree + 1]) {
  for (Vec& c : p) c = Set(0.0);
  for (int i = 0; i < 3; ++i) {
    const PolynomialRow &next = B[(i + 1) % 3], &last = B[(i + 2) % 3];
    Vec minor[7];
    for (Vec& c : minor) c = Set(0.0);
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        minor[a + b] = FusedMulAdd(next.x[a], last.y[b], minor[a + b]);
        minor[a + b] = FusedNegMulAdd(next.y[a], last.x[b], minor[a + b]);
      }
    }
    for (int a = 0; a < 7; ++a) {
      for (int b = 0; b < 5; ++b) p[a + b] = FusedMulAdd(minor[a], B[i].one[b], p[a + b]);
    }
  }
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
