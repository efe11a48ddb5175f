// The essential matrices at the roots of the five-point problem, many side by side. Each root may belong to
// another sample.
//
// A root gives the coordinates c = (x, y, z, w) of E in the basis E_1 ... E_4 of the null space, with the
// rounding errors of the elimination. They are polished by Newton's method on the essential matrices. The
// three matrices N_i normal to these at E give N_i . (sum_k c_k E_k) = 0, three linear equations for c up to
// scale. With the singular value decomposition E = s (u1 v1' + u2 v2') they are
//
//   N = u1 v1' - u2 v2', u1 v2' + u2 v1', u3 v3'.
//
// The columns of E are normal to u3. Let n be a cross product of two of them, p one of the two, and q = n x
// p, which is |n| times as long. Then n^2 p (E'p)' - q (E'q)' and p (E'q)' + q (E'p)' span the same as the
// first two, and no square root is needed. While E is not essential yet, these two are half the gradients of
// n^2 |E'p|^2 - |E'q|^2 and 2 (E'p) . (E'q). These functions have degree two in E, so the equations are N .
// (sum_k c'_k E_k) = N . E / 2.
#if defined(RCME_ESTIMATOR_KERNELS_FIVE_POINT_RECOVERY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RCME_ESTIMATOR_KERNELS_FIVE_POINT_RECOVERY_INL_H_
#undef RCME_ESTIMATOR_KERNELS_FIVE_POINT_RECOVERY_INL_H_
#else
#define RCME_ESTIMATOR_KERNELS_FIVE_POINT_RECOVERY_INL_H_
#endif

#include "estimator/kernels/five_point_brackets-inl.h"
#include "estimator/kernels/five_point_polynomial-inl.h"
#include "estimator/kernels/lanes-inl.h"
#include "estimator/kernels/lookup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

struct Vec4 {
  Vec x, y, z, w;
};
HWY_INLINE Vec Dot(const Vec4& a, const Vec4& b) {
  return FusedMulAdd(a.x, b.x, a.y * b.y) + FusedMulAdd(a.z, b.z, a.w * b.w);
}
HWY_INLINE Vec4 Times(const Vec4& a, Vec s) { return {a.x * s, a.y * s, a.z * s, a.w * s}; }

// The vector normal to a, b and c: its length is the volume that they span.
HWY_INLINE Vec4 Normal(const Vec4& a, const Vec4& b, const Vec4& c) {
  const Vec xy = FusedMulSub(a.x, b.y, a.y * b.x), xz = FusedMulSub(a.x, b.z, a.z * b.x);
  const Vec xw = FusedMulSub(a.x, b.w, a.w * b.x), yz = FusedMulSub(a.y, b.z, a.z * b.y);
  const Vec yw = FusedMulSub(a.y, b.w, a.w * b.y), zw = FusedMulSub(a.z, b.w, a.w * b.z);
  return {FusedMulAdd(c.y, zw, FusedMulSub(c.w, yz, c.z * yw)),
          FusedMulSub(c.z, xw, FusedMulAdd(c.w, xz, c.x * zw)),
          FusedMulAdd(c.x, yw, FusedMulSub(c.w, xy, c.y * xw)),
          FusedMulSub(c.y, xz, FusedMulAdd(c.z, xy, c.x * yz))};
}

// The longest cross product of three vectors in a plane, its squared length, and its first factor.
struct LongCross {
  Vec3 vector, factor;
  Vec squared;
};
HWY_INLINE LongCross LongestCross(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = Cross(a, b), bc = Cross(b, c), ca = Cross(c, a);
  const Vec of_ab = Dot(ab, ab), of_bc = Dot(bc, bc), of_ca = Dot(ca, ca);
  const Mask is_bc = of_bc > of_ab;
  const Vec larger = Greater(of_bc, of_ab);
  const Mask is_ca = of_ca > larger;
  return {Select(is_ca, ca, Select(is_bc, bc, ab)), Select(is_ca, c, Select(is_bc, b, a)),
          Greater(of_ca, larger)};
}

// Scales a by a power of two, so that the sum of its absolute values is between one and two. This keeps
// products of many factors finite.
HWY_INLINE Vec4 Scaled(const Vec4& a) {
  using Bits = hn::RebindToUnsigned<Tag>;
  const Vec size = (hn::Abs(a.x) + hn::Abs(a.y)) + (hn::Abs(a.z) + hn::Abs(a.w));
  const auto exponent =
      hn::And(hn::BitCast(Bits(), size), hn::Set(Bits(), std::uint64_t{0x7ff0000000000000}));
  return Times(a, hn::BitCast(Tag(), hn::Set(Bits(), std::uint64_t{0x7fe0000000000000}) - exponent));
}

// Coordinates at a root t. With n the null vector of B they are (n_0, n_1, z n_2, n_2) in the chart z and
// (n_0, n_1, n_2, u n_2) in the chart u. n is the longest cross product of two rows.
HWY_INLINE Vec4 CoordinatesAtRoot(const BlockPolynomials& polynomials, const Lookup& lookup, Mask is_inverse,
                                  Vec t) {
  const Vec one = Set(1.0), z = hn::IfThenElse(is_inverse, one, t), w = hn::IfThenElse(is_inverse, t, one);
  const Vec z2 = z * z, w2 = w * w;
  const Vec cubes[4] = {w2 * w, w2 * z, w * z2, z2 * z};
  const Vec fourths[5] = {w2 * w2, w2 * w * z, w2 * z2, w * z * z2, z2 * z2};
  const auto& B = polynomials.B;
  Vec3 rows[3];
  for (int i = 0; i < 3; ++i) {
    rows[i] = {lookup(B[i][0]) * cubes[0], lookup(B[i][4]) * cubes[0], lookup(B[i][8]) * fourths[0]};
    for (int c = 1; c < 4; ++c) {
      rows[i].x = FusedMulAdd(lookup(B[i][c]), cubes[c], rows[i].x);
      rows[i].y = FusedMulAdd(lookup(B[i][4 + c]), cubes[c], rows[i].y);
    }
    for (int c = 1; c < 5; ++c) rows[i].z = FusedMulAdd(lookup(B[i][8 + c]), fourths[c], rows[i].z);
  }
  const Vec3 n = LongestCross(rows[0], rows[1], rows[2]).vector;
  return Scaled({n.x, n.y, n.z * z, n.z * w});
}

// The basis of every lane's sample: E_k(i, j) in E[k].row[i].
struct SampleBasis {
  Mat3 E[4];

  SampleBasis(const BlockPolynomials& polynomials, const Lookup& lookup) {
    const auto& basis = polynomials.basis;
    for (int k = 0; k < 4; ++k) {
      for (int i = 0; i < 3; ++i) {
        E[k].row[i] = {lookup(basis[3 * i][k]), lookup(basis[3 * i + 1][k]), lookup(basis[3 * i + 2][k])};
      }
    }
  }
  HWY_INLINE Mat3 operator()(const Vec4& c) const {
    Mat3 sum;
    for (int i = 0; i < 3; ++i) {
      const Vec3 a = Combine(E[0].row[i], c.x, E[1].row[i], c.y),
                 b = Combine(E[2].row[i], c.z, E[3].row[i], c.w);
      sum.row[i] = {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    return sum;
  }
  // N . E_k, k = 1 ... 4.
  HWY_INLINE Vec4 Products(const Mat3& N) const {
    const auto product = [&](const Mat3& e) {
      return Dot(N.row[0], e.row[0]) + Dot(N.row[1], e.row[1]) + Dot(N.row[2], e.row[2]);
    };
    return {product(E[0]), product(E[1]), product(E[2]), product(E[3])};
  }
};

struct NewtonStep {
  Vec4 c;           // of any length
  Mask is_short;    // turns c by less than 1e-6; the remaining error, its square, is negligible
  Mask is_regular;  // the three equations are independent: their unit vectors span a volume above 1e-9
};

// 2 c^2 a - (a . c) c: a, up to its length, without half of its component along c.
HWY_INLINE Vec4 Halfway(const Vec4& a, const Vec4& c, Vec twice_squared) {
  const Vec along = Dot(a, c);
  return {FusedMulSub(twice_squared, a.x, along * c.x), FusedMulSub(twice_squared, a.y, along * c.y),
          FusedMulSub(twice_squared, a.z, along * c.z), FusedMulSub(twice_squared, a.w, along * c.w)};
}

// p r' + q s'
HWY_INLINE Vec4 ProductsOfSum(const SampleBasis& basis, const Vec3& p, const Vec3& r, const Vec3& q,
                              const Vec3& s) {
  return basis.Products({{Combine(r, p.x, s, q.x), Combine(r, p.y, s, q.y), Combine(r, p.z, s, q.z)}});
}

HWY_INLINE NewtonStep TakeNewtonStep(const SampleBasis& basis, const Vec4& c) {
  const Mat3 E = basis(c);
  const Vec3* r = E.row;
  const LongCross n =
      LongestCross({r[0].x, r[1].x, r[2].x}, {r[0].y, r[1].y, r[2].y}, {r[0].z, r[1].z, r[2].z});
  const Vec3 &p = n.factor, q = Cross(n.vector, p);
  const Vec3 Ep = TransposeTimes(E, p), Eq = TransposeTimes(E, q), v3 = Cross(Ep, Eq);
  const Vec squared = Dot(c, c), twice_squared = squared + squared;
  const Vec4 first =
      Halfway(ProductsOfSum(basis, p, Times(Ep, n.squared), q, Times(Eq, Set(-1.0))), c, twice_squared);
  const Vec4 second = Halfway(ProductsOfSum(basis, p, Eq, q, Ep), c, twice_squared);
  const Vec4 third = basis.Products({{Times(v3, n.vector.x), Times(v3, n.vector.y), Times(v3, n.vector.z)}});

  const Vec4 next = Normal(first, second, third);
  const Vec next_squared = Dot(next, next), lengths = next_squared * squared;
  const Vec edges = Dot(first, first) * Dot(second, second) * Dot(third, third);
  const Vec cosine = Dot(next, c);
  return {Scaled(next), FusedNegMulAdd(cosine, cosine, lengths) < Set(1e-12) * lengths,
          next_squared > Set(1e-18) * edges};
}

// Matrices at the roots of a block, index [..][root].
struct alignas(64) RecoveredRoots {
  double c[4][Brackets::kCapacity];
  double E[9][Brackets::kCapacity];            // row by row
  std::uint8_t is_model[Brackets::kCapacity];  // 1: converged, and an isolated solution
};

HWY_INLINE void StoreCoordinates(const Vec4& c, int first, double (*to)[Brackets::kCapacity]) {
  Store(c.x, to[0] + first);
  Store(c.y, to[1] + first);
  Store(c.z, to[2] + first);
  Store(c.w, to[3] + first);
}
// Stores the matrices with Frobenius norm sqrt(2).
HWY_INLINE void StoreMatrices(const SampleBasis& basis, const Vec4& c, int first,
                              double (*to)[Brackets::kCapacity]) {
  const Mat3 E = basis(Times(c, Set(1.41421356237309504880) / hn::Sqrt(Dot(c, c))));
  for (int i = 0; i < 3; ++i) {
    Store(E.row[i].x, to[3 * i] + first);
    Store(E.row[i].y, to[3 * i + 1] + first);
    Store(E.row[i].z, to[3 * i + 2] + first);
  }
}

// Roots that need more than one step. They are few, so they are packed again.
struct alignas(64) UnsettledRoots {
  int number[Brackets::kCapacity];  // index among the roots of the block
  std::int64_t sample[Brackets::kCapacity];
  double c[4][Brackets::kCapacity];
  int count = 0;

  HWY_INLINE void Add(int root, std::int64_t of_sample, const RecoveredRoots& roots) {
    number[count] = root;
    sample[count] = of_sample;
    for (int k = 0; k < 4; ++k) c[k][count] = roots.c[k][root];
    ++count;
  }
  // Whole vectors are read. The places beyond the last hold the first root again, which needs no further
  // steps.
  void Close() {
    for (int i = count; i < count + kBlockSize; ++i) {
      sample[i] = sample[0];
      for (auto& row : c) row[i] = row[0];
    }
  }
};

constexpr int kMaxNewtonSteps = 5;

// Takes up to kMaxNewtonSteps steps, including the first one. A lane that has converged does not move any
// more, whatever the other lanes need.
HWY_INLINE Mask SettleCoordinates(const SampleBasis& basis, Vec4* c) {
  Mask is_done = MaskFromBits(0), is_regular = hn::Not(is_done);
  for (int step = 1; step < kMaxNewtonSteps; ++step) {
    const NewtonStep next = TakeNewtonStep(basis, *c);
    c->x = hn::IfThenElse(is_done, c->x, next.c.x);
    c->y = hn::IfThenElse(is_done, c->y, next.c.y);
    c->z = hn::IfThenElse(is_done, c->z, next.c.z);
    c->w = hn::IfThenElse(is_done, c->w, next.c.w);
    is_regular = hn::And(is_regular, hn::Or(is_done, next.is_regular));
    is_done = hn::Or(is_done, next.is_short);
    if (hn::AllTrue(Tag(), hn::Or(is_done, hn::Not(is_regular)))) break;
  }
  return hn::And(is_done, is_regular);
}

inline void Settle(const BlockPolynomials& polynomials, UnsettledRoots* unsettled, RecoveredRoots* roots) {
  if (unsettled->count == 0) return;
  unsettled->Close();
  for (int first = 0; first < unsettled->count; first += kLanes) {
    const SampleBasis of_sample(polynomials, Lookup(unsettled->sample + first));
    Vec4 c = {Load(unsettled->c[0] + first), Load(unsettled->c[1] + first), Load(unsettled->c[2] + first),
              Load(unsettled->c[3] + first)};
    const unsigned is_model = ReadMaskBits(SettleCoordinates(of_sample, &c));
    alignas(64) double E[9][Brackets::kCapacity];
    StoreMatrices(of_sample, c, 0, E);
    for (int lane = 0; lane < kLanes && first + lane < unsettled->count; ++lane) {
      const int root = unsettled->number[first + lane];
      for (int i = 0; i < 9; ++i) roots->E[i][root] = E[i][lane];
      roots->is_model[root] = (is_model >> lane) & 1u;
    }
  }
}

// The essential matrices at roots, in the order of the brackets.
inline void RecoverMatrices(const BlockPolynomials& polynomials, const Brackets& brackets, const double* t,
                            RecoveredRoots* roots) {
  UnsettledRoots unsettled;
  for (int first = 0; first < brackets.count; first += kLanes) {
    const Lookup lookup(brackets.sample + first);
    const Mask is_inverse = Load(brackets.is_inverse + first) > Set(0.5);
    const SampleBasis of_sample(polynomials, lookup);
    const NewtonStep step =
        TakeNewtonStep(of_sample, CoordinatesAtRoot(polynomials, lookup, is_inverse, Load(t + first)));
    StoreCoordinates(step.c, first, roots->c);
    StoreMatrices(of_sample, step.c, first, roots->E);
    const unsigned is_regular = ReadMaskBits(step.is_regular),
                   is_model = is_regular & ReadMaskBits(step.is_short);
    for (int lane = 0; lane < kLanes; ++lane) roots->is_model[first + lane] = (is_model >> lane) & 1u;
    const int num_left = brackets.count - first;
    unsigned others = is_regular & ~is_model;
    if (num_left < kLanes) others &= (1u << num_left) - 1u;
    for (; others != 0; others &= others - 1) {
      const int root = first + __builtin_ctz(others);
      unsettled.Add(root, brackets.sample[root], *roots);
    }
  }
  Settle(polynomials, &unsettled, roots);
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
