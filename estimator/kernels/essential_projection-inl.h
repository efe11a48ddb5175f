// The essential matrix nearest to a 3x3 matrix M (eq::motion_estimate), without iteration.
//
// u3, the left singular vector of the smallest singular value, is the eigenvector of the smallest eigenvalue
// of M M' (closed form for a symmetric 3x3 matrix: Smith 1961). For any orthonormal u1, u2 normal to it, the
// rows r_i = u_i' M span the plane normal to v3. In bases of the two planes, M is the 2x2 matrix
//
//   B = [[a, 0], [c, d]],   a = |r1|, v1 = r1 / a, c = r2'v1, d = r2'v2 > 0,
//
// whose singular values are the larger two of M. Its nearest rotation is the one by theta with tan
// theta = c / (a + d). So E = ut1 v1' + ut2 v2', where ut are the u rotated by theta. No SVD is needed.
#if defined(RCME_ESTIMATOR_KERNELS_ESSENTIAL_PROJECTION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RCME_ESTIMATOR_KERNELS_ESSENTIAL_PROJECTION_INL_H_
#undef RCME_ESTIMATOR_KERNELS_ESSENTIAL_PROJECTION_INL_H_
#else
#define RCME_ESTIMATOR_KERNELS_ESSENTIAL_PROJECTION_INL_H_
#endif

#include "estimator/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

struct EssentialBasis {
  Vec3 u[3], v[3];  // E = u1 v1' + u2 v2'; u3 and v3 its null vectors
  Vec misfit[3];    // components of M - E, in [u1 v1' - u2 v2', u1 v2' + u2 v1'] / sqrt(2) and u3 v3'
  Mask determines_direction;  // the second singular value of M exceeds 1e-9 of the first
};

// cos(acos(c) / 3) for c in [-1, 1], from s = sqrt((1 + c) / 2). As acos(c) = 2 acos(s), it is cos(2/3
// acos(s)), which is analytic except at s = -1. The error of its Chebyshev interpolant of degree 18 on [0,
// 1], in powers of w = 2 s - 1, is at most 2.7e-17 before rounding.
HWY_INLINE Vec CosineOfThird(Vec s) {
  constexpr double kCoefficients[] = {
      0.766044443118978,       0.2474090663228534,     -0.015509188436485936,   0.0024663528150656285,
      -0.0005041246911381233,  0.00011642545331824931, -2.891993630551945e-05,  7.541075563453027e-06,
      -2.0358696650818406e-06, 5.641643328528482e-07,  -1.5954336266674776e-07, 4.5826322066904776e-08,
      -1.334861626366851e-08,  3.982036064644077e-09,  -1.1846250703174136e-09, 3.093616173100703e-10,
      -9.309326514430476e-11,  5.11466452650849e-11,   -1.5686102744613355e-11};
  const Vec w = FusedMulSub(Set(2.0), s, Set(1.0));
  Vec sum = Set(kCoefficients[18]);
  for (int k = 17; k >= 0; --k) sum = FusedMulAdd(sum, w, Set(kCoefficients[k]));
  return sum;
}

// Unit eigenvector of the smallest eigenvalue of S (symmetric, positive semi-definite).
HWY_INLINE Vec3 SmallestEigenvector(const Mat3& S) {
  const Vec mean = (S.row[0].x + S.row[1].y + S.row[2].z) * Set(1.0 / 3.0);
  const Vec a = S.row[0].x - mean, b = S.row[1].y - mean, c = S.row[2].z - mean;
  const Vec off_diagonal = Dot({S.row[0].y, S.row[0].z, S.row[1].z}, {S.row[0].y, S.row[0].z, S.row[1].z});
  const Vec p = hn::Sqrt((Dot({a, b, c}, {a, b, c}) + off_diagonal + off_diagonal) * Set(1.0 / 6.0));
  // det(S - mean I) / (2 p^3) is the cosine of three times the angle of the eigenvalues; the smallest is
  // mean + 2 p cos(angle + 2 pi / 3) = mean - 2 p cos(acos(-cosine) / 3).
  const Vec3 shifted0 = {a, S.row[0].y, S.row[0].z}, shifted1 = {S.row[1].x, b, S.row[1].z},
             shifted2 = {S.row[2].x, S.row[2].y, c};
  const Vec cosine = Dot(shifted0, Cross(shifted1, shifted2)) / (Set(2.0) * p * p * p);
  const Vec half =
      Greater(Lesser(FusedMulAdd(Set(-0.5), cosine, Set(0.5)), Set(1.0)), Set(0.0));  // (1 - cosine) / 2
  const Vec smallest = FusedNegMulAdd(p + p, CosineOfThird(hn::Sqrt(half)), mean);

  const Vec3 row0 = {S.row[0].x - smallest, S.row[0].y, S.row[0].z};
  const Vec3 row1 = {S.row[1].x, S.row[1].y - smallest, S.row[1].z};
  const Vec3 row2 = {S.row[2].x, S.row[2].y, S.row[2].z - smallest};
  Vec3 best = Cross(row0, row1);
  Vec best_norm = Dot(best, best);
  for (const Vec3& other : {Cross(row0, row2), Cross(row1, row2)}) {
    const Vec norm = Dot(other, other);
    best = Select(norm > best_norm, other, best);
    best_norm = Greater(norm, best_norm);
  }
  return Normalized(best);
}

// Completes the unit vector n to an orthonormal basis (Duff et al. 2017).
HWY_INLINE void CompleteBasis(const Vec3& n, Vec3* first, Vec3* second) {
  const Vec one = Set(1.0), sign = hn::CopySign(one, n.z);
  const Vec a = Set(-1.0) / (sign + n.z), b = n.x * n.y * a;
  *first = {FusedMulAdd(sign * n.x, n.x * a, one), sign * b, hn::Neg(sign * n.x)};
  *second = {b, FusedMulAdd(n.y, n.y * a, sign), hn::Neg(n.y)};
}

// One Newton step for the eigenvector of M M', with S = M M' in the basis u1, u2, u. If the relative gap d of
// the two smaller singular values is small, the closed form computes the angle of a cosine near one, with an
// error of eps / d^2; the step reduces it to eps / d. No step is taken if S does not separate the two.
HWY_INLINE Vec3 Polish(const Mat3& M, const Vec3& u) {
  Vec3 u1, u2;
  CompleteBasis(u, &u1, &u2);
  const Vec3 r1 = TransposeTimes(M, u1), r2 = TransposeTimes(M, u2), r3 = TransposeTimes(M, u);
  const Vec smallest = Dot(r3, r3);
  const Vec a = Dot(r1, r1) - smallest, b = Dot(r1, r2), c = Dot(r2, r2) - smallest;
  const Vec determinant = FusedMulSub(a, c, b * b);
  const Mask is_determined = determinant > Set(1e-20) * Square(a + c);
  const Vec inverse = hn::IfThenElseZero(is_determined, Set(1.0) / determinant);
  const Vec p = Dot(r1, r3), q = Dot(r2, r3);
  const Vec along1 = FusedMulSub(b, q, c * p) * inverse, along2 = FusedMulSub(b, p, a * q) * inverse;
  const Vec3 step = Combine(u1, along1, u2, along2);
  return Normalized({u.x + step.x, u.y + step.y, u.z + step.z});
}

HWY_INLINE EssentialBasis ProjectToEssential(const Mat3& M) {
  EssentialBasis basis;
  Vec3 u1, u2;
  basis.u[2] = Polish(M, SmallestEigenvector({M * M.row[0], M * M.row[1], M * M.row[2]}));
  CompleteBasis(basis.u[2], &u1, &u2);
  const Vec3 r1 = TransposeTimes(M, u1), r2 = TransposeTimes(M, u2);
  basis.v[2] = Normalized(Cross(r1, r2));
  const Vec a = hn::Sqrt(Dot(r1, r1));
  basis.v[0] = Times(r1, Set(1.0) / a);
  basis.v[1] = Cross(basis.v[2], basis.v[0]);
  const Vec c = Dot(r2, basis.v[0]), d = Dot(r2, basis.v[1]);

  const Vec sum = a + d, h = hn::Sqrt(FusedMulAdd(sum, sum, c * c)), inverse_h = Set(1.0) / h;  // s1 + s2
  const Vec cos = sum * inverse_h, sin = c * inverse_h;
  basis.u[0] = Combine(u1, cos, u2, sin);
  basis.u[1] = Combine(u2, cos, u1, hn::Neg(sin));
  const Vec difference = hn::Sqrt(FusedMulAdd(a - d, a - d, c * c));  // s1 - s2
  basis.determines_direction = (h - difference) > Set(1e-9) * (h + difference);

  const Vec root_half = Set(0.70710678118654752440);
  basis.misfit[0] = (a * cos + c * sin - d * cos) * root_half;
  basis.misfit[1] = (d * sin - a * sin + c * cos) * root_half;
  basis.misfit[2] = Dot(basis.u[2], M * basis.v[2]);
  return basis;
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
