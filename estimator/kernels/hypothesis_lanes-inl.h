// From samples and motions to F and its derivatives, for several hypotheses side by side.
#if defined(RCME_ESTIMATOR_KERNELS_HYPOTHESIS_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RCME_ESTIMATOR_KERNELS_HYPOTHESIS_LANES_INL_H_
#undef RCME_ESTIMATOR_KERNELS_HYPOTHESIS_LANES_INL_H_
#else
#define RCME_ESTIMATOR_KERNELS_HYPOTHESIS_LANES_INL_H_
#endif

#include "estimator/kernels/essential_projection-inl.h"
#include "estimator/kernels/hypothesis_block.h"
#include "estimator/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

// The samples of some lanes of a block, m matches each.
template <int m>
struct SampleLanes {
  Vec x1[m], y1[m], x2[m], y2[m];

  SampleLanes(const HypothesisBlock& block, int lane) {
    for (int k = 0; k < m; ++k) {
      x1[k] = Load(block.x1[k] + lane);
      y1[k] = Load(block.y1[k] + lane);
      x2[k] = Load(block.x2[k] + lane);
      y2[k] = Load(block.y2[k] + lane);
    }
  }
};

// Converts matrices for rays to whitened coordinates: entry (i, j) times second[i] first[j]
// (eq::model_motion_relation).
struct Whitening {
  Vec first[3], second[3];
  explicit Whitening(const RayScale& s)
      : first{Set(s.x1), Set(s.y1), Set(1.0)}, second{Set(s.x2), Set(s.y2), Set(1.0)} {}
  Vec operator()(int i, int j, Vec entry) const { return entry * (second[i] * first[j]); }
};

// The constraints kron(x2, x1) of a sample, for rays.
template <int m>
HWY_INLINE void FillConstraints(const SampleLanes<m>& sample, const Whitening& whitening,
                                Vec (&columns)[m][9]) {
  for (int k = 0; k < m; ++k) {
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

// D_k = |J|^2 of the sample's constraints under the model f.
template <int m>
HWY_INLINE void ConstraintVariances(const SampleLanes<m>& sample, const Whitening& whitening, const Vec* f,
                                    Vec* D) {
  Vec F[9];
  for (int i = 0; i < 9; ++i) F[i] = whitening(i / 3, i % 3, f[i]);
  for (int k = 0; k < m; ++k) {
    const Vec in_2_x = FusedMulAdd(F[0], sample.x1[k], FusedMulAdd(F[1], sample.y1[k], F[2]));
    const Vec in_2_y = FusedMulAdd(F[3], sample.x1[k], FusedMulAdd(F[4], sample.y1[k], F[5]));
    const Vec in_1_x = FusedMulAdd(F[0], sample.x2[k], FusedMulAdd(F[3], sample.y2[k], F[6]));
    const Vec in_1_y = FusedMulAdd(F[1], sample.x2[k], FusedMulAdd(F[4], sample.y2[k], F[7]));
    D[k] = FusedMulAdd(in_2_x, in_2_x,
                       FusedMulAdd(in_2_y, in_2_y, FusedMulAdd(in_1_x, in_1_x, in_1_y * in_1_y)));
  }
}

// The products u_i v_j' of the projection are an orthonormal basis of the 3x3 matrices. Five of them (and
// combinations) span the motions:
//
//   T = (u1 v2' - u2 v1') / sqrt(2), u3 v1', u3 v2', u1 v3', u2 v3'
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

// dE along a principal axis with coordinates l in T: sqrt(2) sum_c l_c T_c, because |E|^2 = 2.
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

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
