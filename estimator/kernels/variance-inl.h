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

// Vectors of matches that are evaluated side by side: with short vectors one loads a coefficient for two of them, and their
// chains of operations overlap.
constexpr int kSideBySide = kBlockSize / kLanes >= 2 ? 2 : 1;

// The value of the polynomial in the monomials of both images, for `num` vectors of matches.
template <int num>
HWY_INLINE void EvaluateVariances(const double* coefficients, const Matches* matches, Vec* values) {
  Vec one[num][5], two[num][5];
  for (int v = 0; v < num; ++v) {
    const Matches& m = matches[v];
    const Vec of_one[] = {m.x1 * m.x1, m.x1 * m.y1, m.x1, m.y1 * m.y1, m.y1};
    const Vec of_two[] = {m.x2 * m.x2, m.x2 * m.y2, m.x2, m.y2 * m.y2, m.y2};
    for (int i = 0; i < 5; ++i) one[v][i] = of_one[i], two[v][i] = of_two[i];
  }
  for (int a = 5; a >= 0; --a) {
    Vec inner[num];
    for (int v = 0; v < num; ++v) inner[v] = Set(coefficients[6 * a + 5]);
    for (int b = 0; b < 5; ++b) {
      const Vec coefficient = Set(coefficients[6 * a + b]);
      for (int v = 0; v < num; ++v) inner[v] = FusedMulAdd(coefficient, one[v][b], inner[v]);
    }
    for (int v = 0; v < num; ++v)
      values[v] = a == 5 ? inner[v] : FusedMulAdd(inner[v], two[v][a], values[v]);
  }
}

// g^2, n2 = |J|^2, and the variance of g due to the motion.
struct RankAwareTerms {
  Vec g2, n2, variance;
};
template <int num>
HWY_INLINE void EvaluateRankAware(const double* F, const double* coefficients, const Matches* matches,
                                  RankAwareTerms* terms) {
  Vec variances[num];
  EvaluateVariances<num>(coefficients, matches, variances);
  for (int v = 0; v < num; ++v) {
    const Constraint c = EvaluateConstraint(Broadcast{F}, matches[v]);
    terms[v] = {c.g * c.g, Dot4(c.gradient, c.gradient), Greater(variances[v], Set(0.0))};
  }
}
HWY_INLINE RankAwareTerms EvaluateRankAware(const double* F, const double* coefficients,
                                            const Matches& matches) {
  RankAwareTerms terms;
  EvaluateRankAware<1>(F, coefficients, &matches, &terms);
  return terms;
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
