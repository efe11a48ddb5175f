// Closed forms, and known answers by mpmath 1.3.0, which integrates the density in Cartesian coordinates:
//
//   from mpmath import *; mp.dps = 25
//   n = lambda x, l: exp(-x*x/(2*l))/sqrt(2*pi*l)
//   def tail(r, a, b, c):
//       inner = lambda x: 2*quad(lambda y: n(y,b)*erf(sqrt(max(mpf(0),r*r-x*x-y*y)/(2*c))),
//                                [0, sqrt(r*r-x*x)/4, sqrt(r*r-x*x)])
//       return 1 - 2*quad(lambda x: n(x,a)*inner(x), [0, r/4, r])
//   tail(mpf(6), mpf(1), mpf('0.9'), mpf('0.5'))
#include "stats/gaussian_norm.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "stats/constants.h"
#include "stats/distributions.h"
#include "stats/intervals.h"
#include "stats/random.h"

namespace rcme {
namespace {

using Eigen::Vector3d;

TEST(GaussianNorm, OfOneEigenvalueIsTheNormalLaw) {
  for (const double tail : {0.9, 0.3, 1e-3, 1e-6, 1e-9}) {
    const double r = -0.2 * NormalQuantile(0.5 * tail);
    EXPECT_NEAR(GaussianNormQuantile({0.0, 0.04, 0.0}, tail), r, 1e-12 * r) << tail;
  }
}

// Rayleigh: P(|e| > r) = exp(-r^2 / (2 s^2)).
TEST(GaussianNorm, OfTwoEqualOnesIsRayleighs) {
  for (const double tail : {0.9, 0.3, 1e-3, 1e-6, 1e-9, 1e-12}) {
    const double r = 0.2 * std::sqrt(-2.0 * std::log(tail));
    EXPECT_NEAR(GaussianNormQuantile({0.04, 0.04, 0.0}, tail), r, 1e-12 * r) << tail;
  }
}

// Maxwell: P(|e| > r) = erfc(x / sqrt 2) + sqrt(2 / pi) x exp(-x^2 / 2), x = r / s.
TEST(GaussianNorm, OfThreeEqualOnesIsMaxwells) {
  for (const double x : {0.01, 0.5, 1.0, 3.0, 6.0, 7.0}) {
    const double tail =
        std::erfc(x / std::numbers::sqrt2) + std::sqrt(2.0 / std::numbers::pi) * x * std::exp(-0.5 * x * x);
    EXPECT_NEAR(GaussianNormQuantile({0.04, 0.04, 0.04}, tail), 0.2 * x, 1e-9 * x) << x;
  }
  EXPECT_NEAR(GaussianNormQuantile({1.0, 1.0, 1.0}, 0.05), std::sqrt(ChiSquareQuantile(3, 0.95)), 1e-9);
}

TEST(GaussianNorm, HasKnownAnswers) {
  const struct {
    double r;
    Vector3d eigenvalues;
    double tail;
  } kKnown[] = {{1.0, {0.5, 1.0, 0.2}, 0.5792822700617264},
                {3.0, {0.01, 0.25, 1.0}, 0.003188196593364262},
                {6.0, {1.0, 0.9, 0.5}, 1.042976298940458e-8},
                {5.0, {1.0, 0.04, 0.0001}, 5.8561175392975e-7}};
  for (const auto& known : kKnown) {
    EXPECT_NEAR(GaussianNormQuantile(known.eigenvalues, known.tail), known.r, 1e-11) << known.r;
  }
}

// From flat to round: what is between two closed forms lies between them.
TEST(GaussianNorm, GrowsWithEveryEigenvalue) {
  for (const double second : {0.0, 1e-12, 1e-6, 1e-3, 0.1, 0.999999, 1.0}) {
    double before = 0.0;
    for (const double share : {0.0, 1e-9, 1e-3, 0.5, 1.0}) {
      for (const double tail : {0.5, 1e-3, 1e-9}) {
        const Vector3d eigenvalues(1.0, second, share * second);
        const double r = GaussianNormQuantile(eigenvalues, tail);
        EXPECT_GE(r, -NormalQuantile(0.5 * tail) * (1.0 - 1e-12));
        if (tail == 1e-3) {
          EXPECT_GE(r, before * (1.0 - 1e-12));
          before = r;
        }
      }
    }
  }
}

// 20 laws with 20,000 draws each; an exact 99.9 % interval misses one of them with probability at most 2 %.
TEST(GaussianNorm, TailIsTheShareOfDrawsBeyondTheQuantile) {
  RandomStream rng({.seed = 5, .purpose = 491});
  for (int law = 0; law < 20; ++law) {
    const Vector3d sd(1.0, rng.Uniform(), rng.Uniform());
    const double tail = rng.Uniform(0.005, 0.6), r = GaussianNormQuantile(sd.cwiseAbs2(), tail);
    int num_beyond = 0;
    constexpr int kNumDraws = 20000;
    for (int i = 0; i < kNumDraws; ++i)
      num_beyond += sd.cwiseProduct(Vector3d(rng.Normal(), rng.Normal(), rng.Normal())).norm() > r;
    EXPECT_TRUE(ExactBinomialInterval(num_beyond, kNumDraws, 0.999).Contains(tail)) << law;
  }
}

// Rayleigh's law with the shares 1 - w and w.
TEST(GaussianNorm, OfAMixtureHasTheTailOfBothLaws) {
  for (const double sd : {0.1, 5.0, 1e4}) {
    for (const double weight : {0.0, 1e-9, 0.01, 0.5, 1.0}) {
      for (const double tail : {0.9, 0.05, 1e-3, 1e-9}) {
        const double r = GaussianNormQuantile({4.0, 4.0, 0.0}, {sd * sd, sd * sd, 0.0}, weight, tail);
        const double beyond =
            (1.0 - weight) * std::exp(-r * r / 8.0) + weight * std::exp(-0.5 * r * r / (sd * sd));
        EXPECT_NEAR(beyond / tail, 1.0, 1e-9) << sd << " " << weight << " " << tail;
      }
    }
  }
  EXPECT_LT(GaussianNormQuantile(Vector3d::Zero(), Vector3d::Ones(), 0.01, 0.05), 1e-12);
}

TEST(GaussianNorm, IsZeroWithoutVariance) { EXPECT_EQ(GaussianNormQuantile(Vector3d::Zero(), 1e-3), 0.0); }

TEST(GaussianNorm, RefusesWhatIsNoLaw) {
  EXPECT_THROW(GaussianNormQuantile({1.0, -1e-9, 0.0}, 0.5), std::invalid_argument);
  EXPECT_THROW(GaussianNormQuantile({1.0, kNaN, 0.0}, 0.5), std::invalid_argument);
  EXPECT_THROW(GaussianNormQuantile({1.0, 1.0, 0.0}, kNaN), std::invalid_argument);
  EXPECT_THROW(GaussianNormQuantile({1.0, 1.0, 0.0}, 1.0), std::invalid_argument);
  EXPECT_THROW(GaussianNormQuantile({1.0, 1.0, 0.0}, 0.0), std::invalid_argument);
  EXPECT_THROW(GaussianNormQuantile({kInfinity, 1.0, 0.0}, 0.5), std::invalid_argument);
}

}  // namespace
}  // namespace rcme
