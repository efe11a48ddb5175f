// The roots of polynomials of degree ten in their brackets, many side by side: Halley's method, kept inside
// the brackets. Each root may belong to another polynomial.
#if defined(RCME_ESTIMATOR_KERNELS_FIVE_POINT_ROOTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RCME_ESTIMATOR_KERNELS_FIVE_POINT_ROOTS_INL_H_
#undef RCME_ESTIMATOR_KERNELS_FIVE_POINT_ROOTS_INL_H_
#else
#define RCME_ESTIMATOR_KERNELS_FIVE_POINT_ROOTS_INL_H_
#endif

#include "estimator/kernels/five_point_brackets-inl.h"
#include "estimator/kernels/lanes-inl.h"
#include "estimator/kernels/lookup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

constexpr int kHalleySteps = 3;

// Two vectors of brackets are refined side by side: a single one is a chain of dependent operations.
constexpr int kRootVectors = 2;

struct RootSearch {
  Vec p[kDegree + 1];  // ascending powers of t
  Vec begin, end, t;
  Mask begins_negative;

  HWY_INLINE void Start(const BlockPolynomials& polynomials, const Brackets& brackets, int first);
  HWY_INLINE void Step();
};

// Starts at the zero of the chord between the ends.
HWY_INLINE void RootSearch::Start(const BlockPolynomials& polynomials, const Brackets& brackets, int first) {
  const Lookup lookup(brackets.sample + first);
  const Mask is_inverse = Load(brackets.is_inverse + first) > Set(0.5);
  Vec of_z[kDegree + 1];
  for (int c = 0; c <= kDegree; ++c) of_z[c] = lookup(polynomials.p[c]);
  for (int c = 0; c <= kDegree; ++c) p[c] = hn::IfThenElse(is_inverse, of_z[kDegree - c], of_z[c]);
  begin = Load(brackets.begin + first);
  end = Load(brackets.end + first);
  const Vec at_begin = Load(brackets.at_begin + first), at_end = Load(brackets.at_end + first);
  begins_negative = at_begin < Set(0.0);
  t = FusedNegMulAdd(at_begin, (end - begin) / (at_end - at_begin), begin);
}

HWY_INLINE void RootSearch::Step() {
  Vec f = p[kDegree], d = Set(0.0), dd = Set(0.0);  // dd: half the second derivative
  for (int c = kDegree - 1; c >= 0; --c) {
    if (c < kDegree - 1) dd = FusedMulAdd(dd, t, d);
    d = c < kDegree - 1 ? FusedMulAdd(d, t, f) : f;
    f = FusedMulAdd(f, t, p[c]);
  }
  const Mask is_on_begin_side = hn::Not(hn::Xor(f < Set(0.0), begins_negative));
  begin = hn::IfThenElse(is_on_begin_side, t, begin);
  end = hn::IfThenElse(is_on_begin_side, end, t);
  const Vec next = FusedNegMulAdd(f, d / FusedNegMulAdd(f, dd, d * d), t);
  const Mask is_inside = hn::And(next >= Lesser(begin, end), next <= Greater(begin, end));
  t = hn::IfThenElse(is_inside, next, Set(0.5) * (begin + end));
}

// Fills `roots` in the order of the brackets. The places beyond the last bracket have no meaning.
HWY_INLINE void RefineRoots(const BlockPolynomials& polynomials, const Brackets& brackets, double* roots) {
  for (int first = 0; first < brackets.count; first += kRootVectors * kLanes) {
    RootSearch search[kRootVectors];
    for (int v = 0; v < kRootVectors; ++v) search[v].Start(polynomials, brackets, first + v * kLanes);
    for (int step = 0; step < kHalleySteps; ++step) {
      for (RootSearch& each : search) each.Step();
    }
    for (int v = 0; v < kRootVectors; ++v) Store(search[v].t, roots + first + v * kLanes);
  }
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
