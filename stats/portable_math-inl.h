// PortableLog and PortableCosSinOfTurn on all lanes of a Highway vector; the scalar functions of
// stats/portable_math.h are these with one lane. They use IEEE +, -, *, / in a fixed order without fused
// multiply-add, so the results are bit-identical on every instruction set.
#if defined(RCME_STATS_PORTABLE_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RCME_STATS_PORTABLE_MATH_INL_H_
#undef RCME_STATS_PORTABLE_MATH_INL_H_
#else
#define RCME_STATS_PORTABLE_MATH_INL_H_
#endif

#include <hwy/highway.h>

#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// c[0] + c[1] x + c[2] x^2 + ..., by Horner's rule.
template <class D, size_t kSize>
HWY_INLINE hn::Vec<D> Polynomial(D d, const double (&c)[kSize], hn::Vec<D> x) {
  hn::Vec<D> sum = hn::Set(d, c[kSize - 1]);
  for (size_t k = kSize - 1; k-- > 0;) sum = hn::Add(hn::Mul(sum, x), hn::Set(d, c[k]));
  return sum;
}

// x = m 2^e with m in [sqrt(1/2), sqrt(2)), then log m = 2 atanh(s), s = (m - 1) / (m + 1), |s| < 0.172.
template <class D>
HWY_INLINE hn::Vec<D> ComputeLog(D d, hn::Vec<D> x) {
  // sum_k s^2k / (2k + 1), k = 0..10; the next term is below 2e-18.
  static constexpr double kAtanh[] = {1.0,      1.0 / 3,  1.0 / 5,  1.0 / 7,  1.0 / 9, 1.0 / 11,
                                      1.0 / 13, 1.0 / 15, 1.0 / 17, 1.0 / 19, 1.0 / 21};
  const hn::RebindToUnsigned<D> du;
  const auto bits = hn::BitCast(du, x);
  const auto one = hn::Set(d, 1.0);
  // An integer below 2^52 placed in the low bits of 2^52 reads as 2^52 + integer; the exponent has a bias of
  // 1023.
  const auto biased = hn::Or(hn::ShiftRight<52>(bits), hn::Set(du, 0x4330000000000000ULL));
  auto exponent = hn::Sub(hn::BitCast(d, biased), hn::Set(d, 0x1p52 + 1023.0));
  const auto fraction = hn::And(bits, hn::Set(du, 0x000fffffffffffffULL));
  auto m = hn::BitCast(d, hn::Or(fraction, hn::Set(du, 0x3ff0000000000000ULL)));
  const auto above = hn::Gt(m, hn::Set(d, std::numbers::sqrt2));
  m = hn::IfThenElse(above, hn::Mul(m, hn::Set(d, 0.5)), m);
  exponent = hn::IfThenElse(above, hn::Add(exponent, one), exponent);

  const auto s = hn::Div(hn::Sub(m, one), hn::Add(m, one));
  const auto log_m = hn::Mul(hn::Mul(hn::Set(d, 2.0), s), Polynomial(d, kAtanh, hn::Mul(s, s)));
  return hn::Add(hn::Mul(exponent, hn::Set(d, std::numbers::ln2)), log_m);
}

template <class D>
struct CosSinOf {
  hn::Vec<D> cos, sin;

  // The nearest quarter turn q and the remaining angle a, |a| <= pi / 4; cos a and sin a by Taylor to a^16
  // and a^17, with next terms below 3e-18. Turned by q quarters: (c, s), (-s, c), (-c, -s), (s, -c).
  HWY_INLINE CosSinOf(D d, hn::Vec<D> u) {
    static constexpr double kCos[] = {1.0,
                                      -1.0 / 2,
                                      1.0 / 24,
                                      -1.0 / 720,
                                      1.0 / 40320,
                                      -1.0 / 3628800,
                                      1.0 / 479001600,
                                      -1.0 / 87178291200,
                                      1.0 / 20922789888000};
    static constexpr double kSin[] = {1.0,
                                      -1.0 / 6,
                                      1.0 / 120,
                                      -1.0 / 5040,
                                      1.0 / 362880,
                                      -1.0 / 39916800,
                                      1.0 / 6227020800,
                                      -1.0 / 1307674368000,
                                      1.0 / 355687428096000};
    const hn::RebindToUnsigned<D> du;
    const auto big = hn::Set(d, 0x1p52);  // 2^52 + 4u is rounded to an integer, q in its low bits
    const auto rounded = hn::Add(hn::Mul(hn::Set(d, 4.0), u), big);
    const auto q_turns = hn::Mul(hn::Set(d, 0.25), hn::Sub(rounded, big));
    const auto a = hn::Mul(hn::Sub(u, q_turns), hn::Set(d, 2.0 * std::numbers::pi));
    const auto a2 = hn::Mul(a, a);
    const auto c = Polynomial(d, kCos, a2);
    const auto s = hn::Mul(a, Polynomial(d, kSin, a2));

    const auto q = hn::BitCast(du, rounded);
    const auto one = hn::Set(du, 1), two = hn::Set(du, 2);
    const auto is_odd = hn::RebindMask(d, hn::TestBit(q, one));
    const auto cos_sign = hn::ShiftLeft<62>(hn::And(hn::Add(q, one), two));
    const auto sin_sign = hn::ShiftLeft<62>(hn::And(q, two));
    cos = hn::Xor(hn::IfThenElse(is_odd, s, c), hn::BitCast(d, cos_sign));
    sin = hn::Xor(hn::IfThenElse(is_odd, c, s), hn::BitCast(d, sin_sign));
  }
};

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
