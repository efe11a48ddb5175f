#include "stats/portable_math.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "stats/random.h"

namespace rcme {
namespace {

// The references are the C library's long double functions (64-bit mantissa on x86: error far below a
// double's).
double RelativeErrorOfLog(double x) {
  const long double exact = std::log(static_cast<long double>(x));
  if (exact == 0.0L) return PortableLog(x) == 0.0 ? 0.0 : 1.0;
  return static_cast<double>(std::abs((static_cast<long double>(PortableLog(x)) - exact) / exact));
}

double ErrorOfCosSin(double u) {
  const long double angle = 2.0L * std::numbers::pi_v<long double> * static_cast<long double>(u);
  const CosSin turn = PortableCosSinOfTurn(u);
  return static_cast<double>(std::max(std::abs(static_cast<long double>(turn.cos) - std::cos(angle)),
                                      std::abs(static_cast<long double>(turn.sin) - std::sin(angle))));
}

TEST(PortableExp, ErrorIsBelow2em15Relative) {
  RandomStream rng({.seed = 1, .purpose = 3});
  double worst = 0.0, worst_x = 0.0;
  for (int i = 0; i < 300'000; ++i) {
    const double x = i % 2 == 0 ? rng.Uniform(-700.0, 700.0) : rng.Uniform(-2.0, 2.0);
    const long double exact = std::exp(static_cast<long double>(x));
    const auto error =
        static_cast<double>(std::abs((static_cast<long double>(PortableExp(x)) - exact) / exact));
    if (!(error <= worst)) worst = error, worst_x = x;
  }
  EXPECT_LT(worst, 2e-15) << worst_x;
  EXPECT_EQ(PortableExp(0.0), 1.0);
  EXPECT_EQ(PortableExp(-701.0), 0.0);
}

TEST(PortableLog, ErrorIsBelow2em15Relative) {
  RandomStream rng({.seed = 1, .purpose = 1});
  double worst = 0.0, worst_x = 0.0;
  const auto check = [&](double x) {
    const double error = RelativeErrorOfLog(x);
    if (!(error <= worst)) worst = error, worst_x = x;
  };
  for (int i = 0; i < 300'000; ++i) {
    check(1.0 - rng.Uniform());                                 // what Normal() feeds it
    check(std::exp2(rng.Uniform(-1021.9, 1023.9)));             // every exponent
    check(1.0 + std::exp2(-rng.Uniform(1.0, 52.0)));            // just above 1
    check(1.0 - std::exp2(-rng.Uniform(1.0, 53.0)));            // just below 1
    check(std::numbers::sqrt2 * (1.0 + 1e-14 * rng.Normal()));  // where the exponent is chosen
    check(std::numbers::sqrt2 / 2.0 * (1.0 + 1e-14 * rng.Normal()));
  }
  for (const double x : {std::numeric_limits<double>::min(), std::numeric_limits<double>::max(),
                         std::nextafter(1.0, 0.0), std::nextafter(1.0, 2.0), 0x1p-53, 0.5, 2.0,
                         std::numbers::e, std::numbers::sqrt2, std::nextafter(std::numbers::sqrt2, 2.0)}) {
    check(x);
  }
  EXPECT_LT(worst, 2e-15) << "at x = " << worst_x;
  EXPECT_GT(worst, 0.0);
  EXPECT_EQ(PortableLog(1.0), 0.0);
}

TEST(PortableLog, KnownAnswers) {
  // python3 -c "from mpmath import *; mp.dps = 25; print(log(mpf(2)**-1022), log(10), log(1 + mpf(2)**-52))"
  EXPECT_NEAR(PortableLog(std::numeric_limits<double>::min()), -708.3964185322641062, 708.0 * 2e-15);
  EXPECT_NEAR(PortableLog(10.0), 2.302585092994045684, 2.3 * 2e-15);
  EXPECT_NEAR(PortableLog(1.0 + 0x1p-52), 2.220446049250312834e-16, 2.2e-16 * 2e-15);
}

TEST(PortableCosSin, ErrorIsBelow5em16Absolute) {
  RandomStream rng({.seed = 1, .purpose = 2});
  double worst = 0.0, worst_u = 0.0;
  const auto check = [&](double u) {
    if (u < 0.0 || u >= 1.0) return;
    const double error = ErrorOfCosSin(u);
    if (!(error <= worst)) worst = error, worst_u = u;
  };
  for (int i = 0; i < 300'000; ++i) {
    check(rng.Uniform());
    // Around the axes and around the borders between the quarters' series.
    check(0.125 * static_cast<double>(rng.IntegerBelow(9)) +
          (rng.Uniform() - 0.5) * std::exp2(-rng.Uniform(1.0, 54.0)));
  }
  for (int eighth = 0; eighth <= 8; ++eighth) {
    const double u = 0.125 * eighth;
    for (const double near : {std::nextafter(u, 0.0), u, std::nextafter(u, 2.0)}) check(near);
  }
  EXPECT_LT(worst, 5e-16) << "at u = " << worst_u;
  EXPECT_GT(worst, 0.0);
}

TEST(PortableCosSin, QuarterTurnsAreExact) {
  const double cosines[] = {1.0, 0.0, -1.0, 0.0}, sines[] = {0.0, 1.0, 0.0, -1.0};
  for (int quarter = 0; quarter < 4; ++quarter) {
    EXPECT_EQ(PortableCosSinOfTurn(0.25 * quarter).cos, cosines[quarter]);
    EXPECT_EQ(PortableCosSinOfTurn(0.25 * quarter).sin, sines[quarter]);
  }
}

}  // namespace
}  // namespace rcme
