#include "stats/portable_math.h"

#include <cmath>
#include <numbers>

#include "stats/portable_math-inl.h"

namespace rcme {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
constexpr hn::CappedTag<double, 1> kOneLane;  // of the baseline instruction set, enough for one lane

}  // namespace

double PortableLog(double x) {
  return hn::GetLane(HWY_NAMESPACE::ComputeLog(kOneLane, hn::Set(kOneLane, x)));
}

// x = k ln 2 + r with |r| <= ln(2) / 2, then e^x = 2^k e^r; ln 2 in two parts, the first of 32 bits, so that
// k times it is exact.
double PortableExp(double x) {
  // 1 / j!, j = 0..13; the next term is below 5e-18.
  static constexpr double kTaylor[] = {1.0,
                                       1.0,
                                       1.0 / 2,
                                       1.0 / 6,
                                       1.0 / 24,
                                       1.0 / 120,
                                       1.0 / 720,
                                       1.0 / 5040,
                                       1.0 / 40320,
                                       1.0 / 362880,
                                       1.0 / 3628800,
                                       1.0 / 39916800,
                                       1.0 / 479001600,
                                       1.0 / 6227020800};
  static constexpr double kLn2High = 0x1.62e42fefp-1, kLn2Low = 0x1.473de6af278edp-34;
  if (x < -700.0) return 0.0;
  const double k = std::floor(x * std::numbers::log2e + 0.5);
  const double r = (x - k * kLn2High) - k * kLn2Low;
  double sum = kTaylor[13];
  for (int j = 13; j-- > 0;) sum = sum * r + kTaylor[j];
  return std::ldexp(sum, static_cast<int>(k));
}

CosSin PortableCosSinOfTurn(double u) {
  const HWY_NAMESPACE::CosSinOf turn(kOneLane, hn::Set(kOneLane, u));
  return {hn::GetLane(turn.cos), hn::GetLane(turn.sin)};
}

}  // namespace rcme
