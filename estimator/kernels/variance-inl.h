// The squared residual of a match and its two variances, from the noise of the match and from the motion. The
// latter is evaluated as one polynomial (VariancePolynomial), which takes 36 multiplications instead of the
// 45 of five bilinear forms.
#if defined(RCME_ESTIMATOR_KERNELS_VARIANCE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RCME_ESTIMATOR_KERNELS_VARIANCE_INL_H_
#undef RCME_ESTIMATOR_KERNELS_VARIANCE_INL_H_
#else
#define RCME_ESTIMATOR_KERNELS_VARIANCE_INL_H_
#endif

#include "estimator/kernels/epipolar-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

// The value of the polynomial in the monomials of both images.
HWY_INLINE Vec EvaluateVariance(const double* coefficients, const Matches& m) {
  const Vec one[] = {m.x1 * m.x1, m.x1 * m.y1, m.x1, m.y1 * m.y1, m.y1};
  const Vec two[] = {m.x2 * m.x2, m.x2 * m.y2, m.x2, m.y2 * m.y2, m.y2};
  Vec value = Set(0.0);
  for (int a = 5; a >= 0; --a) {
    Vec inner = Set(coefficients[6 * a + 5]);
    for (int b = 0; b < 5; ++b) inner = FusedMulAdd(Set(coefficients[6 * a + b]), one[b], inner);
    value = a == 5 ? inner : FusedMulAdd(inner, two[a], value);
  }
  return value;
}

// g^2, n2 = |J|^2, and the variance of g due to the motion.
struct RankAwareTerms {
  Vec g2, n2, variance;
};
HWY_INLINE RankAwareTerms EvaluateRankAware(const double* F, const double* coefficients,
                                            const Matches& matches) {
  const Constraint c = EvaluateConstraint(Broadcast{F}, matches);
  const Vec n2 = Dot4(c.gradient, c.gradient);
  return {c.g * c.g, n2, Greater(EvaluateVariance(coefficients, matches), Set(0.0))};
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
