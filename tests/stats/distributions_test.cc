// Known answers by mpmath 1.3.0 at 30 digits:
//
//   python3 -c "from mpmath import *; mp.dps = 30
//   F = lambda k, x: gammainc(mpf(k) / 2, 0, mpf(x) / 2, regularized=True)
//   print(findroot(lambda x: F(3, x) - mpf('0.95'), (mpf('1e-6'), 60), solver='anderson', tol=1e-40,
//                  maxsteps=500, verify=False), F(3, 3), sqrt(2) * erfinv(2 * mpf('0.975') - 1), ncdf(3))"
#include "stats/distributions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace rcme {
namespace {

void ExpectRelative(double value, double exact, double tolerance) {
  EXPECT_NEAR(value, exact, tolerance * std::abs(exact));
}

TEST(ChiSquare, QuantilesAreTheKnownOnes) {
  const struct {
    int dof;
    double probability, quantile;
  } kKnown[] = {
      {1, 0.05, 0.0039321400000195227}, {1, 0.5, 0.45493642311957275}, {1, 0.95, 3.841458820694126},
      {2, 0.05, 0.10258658877510107},   {2, 0.5, 1.3862943611198906},  {2, 0.95, 5.991464547107982},
      {3, 0.05, 0.3518463177492714},    {3, 0.5, 2.3659738843753383},  {3, 0.95, 7.81472790325118},
      {5, 0.05, 1.1454762260617692},    {5, 0.5, 4.3514601910955273},  {5, 0.95, 11.070497693516354},
      {8, 0.05, 2.7326367934996619},    {8, 0.5, 7.3441214977017922},  {8, 0.95, 15.507313055865454},
  };
  for (const auto& known : kKnown) {
    ExpectRelative(ChiSquareQuantile(known.dof, known.probability), known.quantile, 1e-12);
    ExpectRelative(ChiSquareCdf(known.dof, known.quantile), known.probability, 1e-13);
  }
}

TEST(ChiSquare, CdfIsTheKnownOne) {
  ExpectRelative(ChiSquareCdf(1, 1.0), 0.6826894921370859, 1e-14);
  ExpectRelative(ChiSquareCdf(3, 3.0), 0.60837482372891104, 1e-14);
  ExpectRelative(ChiSquareCdf(8, 20.0), 0.98966394932407428, 1e-14);
  EXPECT_EQ(ChiSquareCdf(3, 0.0), 0.0);
}

TEST(ChiSquare, TwoDegreesOfFreedomIsAnExponential) {
  for (const double p : {1e-9, 0.05, 0.5, 0.95, 0.9999}) {
    ExpectRelative(ChiSquareQuantile(2, p), -2.0 * std::log1p(-p), 1e-12);
  }
}

// One degree of freedom is the square of a shifted normal; two are a Poisson mixture of central ones
// (Johnson, Kotz & Balakrishnan 1995, chapter 29).
TEST(NonCentralChiSquare, IsWhatItIsMadeOf) {
  for (const double shift : {0.0, 0.3, 1.5, 4.0}) {
    for (const double x : {0.1, 1.0, 9.21, 30.0}) {
      const double root = std::sqrt(x);
      ExpectRelative(NonCentralChiSquareCdf(1, shift * shift, x),
                     NormalCdf(root - shift) - NormalCdf(-root - shift), 1e-10);
      double mixture = 0.0, weight = std::exp(-0.5 * shift * shift);
      for (int k = 0; k < 80; ++k) {
        mixture += weight * ChiSquareCdf(2 + 2 * k, x);
        weight *= 0.5 * shift * shift / (k + 1);
      }
      ExpectRelative(NonCentralChiSquareCdf(2, shift * shift, x), mixture, 1e-10);
    }
  }
}

TEST(Normal, QuantilesAndCdfAreTheKnownOnes) {
  const struct {
    double probability, quantile;
  } kKnown[] = {{0.001, -3.0902323061678135},
                {0.025, -1.9599639845400542},
                {0.95, 1.6448536269514727},
                {0.975, 1.9599639845400542},
                {0.9999, 3.7190164854556806}};
  for (const auto& known : kKnown) {
    ExpectRelative(NormalQuantile(known.probability), known.quantile, 1e-12);
    ExpectRelative(NormalCdf(known.quantile), known.probability, 1e-13);
  }
  EXPECT_EQ(NormalQuantile(0.5), 0.0);
  ExpectRelative(NormalCdf(-8.0), 6.2209605742717841e-16, 1e-12);  // the tail keeps its digits
  ExpectRelative(NormalCdf(3.0), 0.99865010196836991, 1e-15);
}

TEST(Normal, SquareIsChiSquareWithOneDegreeOfFreedom) {
  for (const double z : {0.1, 1.0, 1.96, 3.5}) {
    ExpectRelative(ChiSquareCdf(1, z * z), 1.0 - 2.0 * NormalCdf(-z), 1e-13);
  }
}

// One and two degrees of freedom in closed form; ten: scipy 1.10, t.ppf(0.975, 10).
TEST(Student, QuantilesAreTheKnownOnes) {
  EXPECT_NEAR(StudentQuantile(1, 0.975), std::tan(0.475 * std::numbers::pi), 1e-9);  // Cauchy
  const double p = 0.95;  // two degrees of freedom: (2 p - 1) / sqrt(2 p (1 - p))
  EXPECT_NEAR(StudentQuantile(2, p), (2.0 * p - 1.0) / std::sqrt(2.0 * p * (1.0 - p)), 1e-12);
  EXPECT_NEAR(StudentQuantile(10, 0.975), 2.2281388519649385, 1e-9);
  EXPECT_NEAR(StudentQuantile(1'000'000, 0.975), NormalQuantile(0.975), 1e-5);
  EXPECT_EQ(StudentQuantile(7, 0.5), 0.0);
}

}  // namespace
}  // namespace rcme
