#include "stats/portable_math.h"

#include <bit>
#include <cstdint>
#include <numbers>

namespace rcme {

double PortableLog(double x) {
  // x = m 2^e with m in [sqrt(1/2), sqrt(2)), then log m = 2 atanh(s), s = (m - 1) / (m + 1), |s| < 0.172.
  const auto bits = std::bit_cast<std::uint64_t>(x);
  int exponent = static_cast<int>(bits >> 52) - 1023;
  double m = std::bit_cast<double>((bits & 0x000fffffffffffffULL) | 0x3ff0000000000000ULL);
  if (m > std::numbers::sqrt2) {
    m *= 0.5;
    ++exponent;
  }
  const double s = (m - 1.0) / (m + 1.0);
  const double s2 = s * s;
  double series = 0.0;  // sum_k s^2k / (2k + 1), k = 0..10; the next term is below 2e-18
  for (int k = 10; k >= 0; --k) series = series * s2 + 1.0 / (2 * k + 1);
  return exponent * std::numbers::ln2 + 2.0 * s * series;
}

CosSin PortableCosSinOfTurn(double u) {
  // The nearest quarter turn, and the angle left over, |a| <= pi / 4.
  const int quarter = static_cast<int>(4.0 * u + 0.5);
  const double a = (u - 0.25 * quarter) * (2.0 * std::numbers::pi);
  const double a2 = a * a;
  double cosine = 0.0, sine = 0.0;  // Taylor to a^18 and a^19
  for (int k = 9; k >= 0; --k) {
    cosine = 1.0 - cosine * a2 / ((2 * k + 1) * (2 * k + 2));
    sine = 1.0 - sine * a2 / ((2 * k + 2) * (2 * k + 3));
  }
  sine *= a;
  switch (quarter & 3) {
    case 0:
      return {cosine, sine};
    case 1:
      return {-sine, cosine};
    case 2:
      return {-cosine, -sine};
    default:
      return {sine, -cosine};
  }
}

}  // namespace rcme
