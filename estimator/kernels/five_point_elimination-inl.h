// The ten cubics that make E = x E_1 + y E_2 + z E_3 + w E_4 an essential matrix, solved for the ten
// monomials whose degree in x and y is two or three (Nister, "An efficient solution to the five-point
// relative pose problem", 2004), for several samples side by side.
#if defined(RCME_ESTIMATOR_KERNELS_FIVE_POINT_ELIMINATION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RCME_ESTIMATOR_KERNELS_FIVE_POINT_ELIMINATION_INL_H_
#undef RCME_ESTIMATOR_KERNELS_FIVE_POINT_ELIMINATION_INL_H_
#else
#define RCME_ESTIMATOR_KERNELS_FIVE_POINT_ELIMINATION_INL_H_
#endif

#include <utility>

#include "estimator/kernels/five_point_null_space-inl.h"
#include "estimator/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

// Homogeneous polynomials in (x, y, z, w) by their coefficients. Quadratics: xx xy xz xw yy yz yw zz zw ww.
// Cubics: xxx yyy xxy xyy xxz xxw yyz yyw xyz xyw, then xzz xzw xww yzz yzw yww zzz zzw zww www.
// The place of the product of variables a and b, and of quadratic monomial q times variable a:
constexpr int kQuadraticPlaces[4][4] = {{0, 1, 2, 3}, {1, 4, 5, 6}, {2, 5, 7, 8}, {3, 6, 8, 9}};
constexpr int kCubicPlaces[10][4] = {{0, 2, 4, 5},     {2, 3, 8, 9},    {4, 8, 10, 11}, {5, 9, 11, 12},
                                     {3, 1, 6, 7},     {8, 6, 13, 14},  {9, 7, 14, 15}, {10, 13, 16, 17},
                                     {11, 14, 17, 18}, {12, 15, 18, 19}};

using Quadratic = Vec[10];
using Cubic = Vec[20];

// The ten cubics, one per row. Stored as numbers, because compilers copy arrays of vectors by slow block
// moves.
struct alignas(64) Constraints {
  double c[10][20][kLanes];
};

// Adds to sum or subtracts from it the product q r of linear forms.
HWY_INLINE void AddProduct(const Vec* q, const Vec* r, Quadratic& sum) {
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      Vec& place = sum[kQuadraticPlaces[a][b]];
      place = FusedMulAdd(q[a], r[b], place);
    }
  }
}
HWY_INLINE void SubtractProduct(const Vec* q, const Vec* r, Quadratic& sum) {
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      Vec& place = sum[kQuadraticPlaces[a][b]];
      place = FusedNegMulAdd(q[a], r[b], place);
    }
  }
}
HWY_INLINE void AddSquare(const Vec* q, Quadratic& sum) {
  for (int a = 0; a < 4; ++a) {
    const Vec twice = q[a] + q[a];
    for (int b = a; b < 4; ++b) {
      Vec& place = sum[kQuadraticPlaces[a][b]];
      place = FusedMulAdd(b == a ? q[a] : twice, q[b], place);
    }
  }
}

// Adds the product q r of a quadratic q and a linear form r to sum.
HWY_INLINE void AddProduct(const Quadratic& q, const Vec* r, Cubic& sum) {
  const Vec form[4] = {r[0], r[1], r[2], r[3]};
#pragma GCC unroll 10
  for (int i = 0; i < 10; ++i) {
    const Vec coefficient = q[i];
#pragma GCC unroll 4
    for (int a = 0; a < 4; ++a) {
      Vec& place = sum[kCubicPlaces[i][a]];
      place = FusedMulAdd(coefficient, form[a], place);
    }
  }
}

// q_0 r_0 + q_1 r_1 + q_2 r_2. Not inlined, so that the sum stays in registers.
HWY_NOINLINE void SumOfProducts(const Quadratic& q0, const Quadratic& q1, const Quadratic& q2, const Vec* r0,
                                const Vec* r1, const Vec* r2, double (*row)[kLanes]) {
  Cubic sum;
  for (Vec& c : sum) c = Set(0.0);
  AddProduct(q0, r0, sum);
  AddProduct(q1, r1, sum);
  AddProduct(q2, r2, sum);
#pragma GCC unroll 20
  for (int c = 0; c < 20; ++c) Store(sum[c], row[c]);
}

HWY_INLINE void SetZero(Quadratic& q) {
  for (Vec& c : q) c = Set(0.0);
}

// The entries of (E E' - 1/2 tr(E E') I) E, then det E.
HWY_INLINE void FillConstraints(const NullSpace& space, Constraints* constraints) {
  const auto E = [&](int i, int j) { return space.E[3 * i + j]; };
  Quadratic EEt[3][3], minors[3];
  for (int i = 0; i < 3; ++i) {
    SetZero(EEt[i][i]);
    for (int k = 0; k < 3; ++k) AddSquare(E(i, k), EEt[i][i]);
    for (int j = i + 1; j < 3; ++j) {
      SetZero(EEt[i][j]);
      for (int k = 0; k < 3; ++k) AddProduct(E(i, k), E(j, k), EEt[i][j]);
    }
  }
  for (int c = 0; c < 10; ++c) {
    const Vec half_trace = Set(0.5) * (EEt[0][0][c] + EEt[1][1][c] + EEt[2][2][c]);
    for (int i = 0; i < 3; ++i) EEt[i][i][c] = EEt[i][i][c] - half_trace;
  }
  const Quadratic* S[3][3] = {{&EEt[0][0], &EEt[0][1], &EEt[0][2]},
                              {&EEt[0][1], &EEt[1][1], &EEt[1][2]},
                              {&EEt[0][2], &EEt[1][2], &EEt[2][2]}};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      SumOfProducts(*S[i][0], *S[i][1], *S[i][2], E(0, j), E(1, j), E(2, j), constraints->c[3 * i + j]);
    }
  }
  for (int j = 0; j < 3; ++j) {  // det E along its first row
    SetZero(minors[j]);
    AddProduct(E(1, (j + 1) % 3), E(2, (j + 2) % 3), minors[j]);
    SubtractProduct(E(1, (j + 2) % 3), E(2, (j + 1) % 3), minors[j]);
  }
  SumOfProducts(minors[0], minors[1], minors[2], E(0, 0), E(0, 1), E(0, 2), constraints->c[9]);
}

// Subtracts multiples of the rows above from row r and scales it to have 1 in column r.
template <int r>
HWY_INLINE void EliminateRow(Constraints* constraints) {
  Cubic row;
#pragma GCC unroll 20
  for (int c = 0; c < 20; ++c) row[c] = Load(constraints->c[r][c]);
#pragma GCC unroll 10
  for (int k = 0; k < r; ++k) {
#pragma GCC unroll 20
    for (int c = k + 1; c < 20; ++c) row[c] = FusedNegMulAdd(row[k], Load(constraints->c[k][c]), row[c]);
  }
  const Vec inverse = Set(1.0) / row[r];
#pragma GCC unroll 20
  for (int c = r + 1; c < 20; ++c) Store(row[c] * inverse, constraints->c[r][c]);
}

// Row r of the solution, from the rows below it.
template <int r>
HWY_INLINE void SubstituteBack(Constraints* constraints) {
  Vec tail[10];
#pragma GCC unroll 10
  for (int c = 0; c < 10; ++c) tail[c] = Load(constraints->c[r][10 + c]);
#pragma GCC unroll 10
  for (int k = r + 1; k < 10; ++k) {
    const Vec factor = Load(constraints->c[r][k]);
#pragma GCC unroll 10
    for (int c = 0; c < 10; ++c) tail[c] = FusedNegMulAdd(factor, Load(constraints->c[k][10 + c]), tail[c]);
  }
#pragma GCC unroll 10
  for (int c = 0; c < 10; ++c) Store(tail[c], constraints->c[r][10 + c]);
}

// Solves for the first ten monomials. There is no pivoting; Mix (five_point_null_space-inl.h) takes its
// place. Only the last six rows are needed, and of these only the last ten columns.
HWY_INLINE void Eliminate(Constraints* constraints) {
  [&]<int... r>(std::integer_sequence<int, r...>) { (EliminateRow<r>(constraints), ...); }
  (std::make_integer_sequence<int, 10>());
  [&]<int... r>(std::integer_sequence<int, r...>) { (SubstituteBack<8 - r>(constraints), ...); }
  (std::make_integer_sequence<int, 5>());
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
