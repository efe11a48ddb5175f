#include "stats/normal_scores.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

#include "stats/consistency.h"
#include "stats/random.h"

namespace rcme {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// The continuous ranked probability score of N(0, sd^2), Gneiting & Raftery (2007), equation 21 with the
// sign turned: sd (z (2 Phi(z) - 1) + 2 phi(z) - 1 / sqrt(pi)), z = e / sd.
double CrpsOfNormal(double e, double sd) {
  const double z = e / sd, phi = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
  return sd * (z * std::erf(z / std::numbers::sqrt2) + 2.0 * phi - 1.0 / std::sqrt(std::numbers::pi));
}

MatrixXd DrawScaledCovariance(RandomStream* rng, double scale_ratio) {
  MatrixXd root(5, 5);
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) root(i, j) = rng->Normal() * std::pow(scale_ratio, i / 4.0);
  return root * root.transpose();
}

TEST(EnergyScore, OfOneCoordinateIsTheCrps) {
  for (const double sd : {1e-6, 1e-3, 0.7, 40.0}) {
    for (const double z : {0.0, 1e-3, 0.5, 1.0, -2.0, 6.0, 50.0, 1e4}) {
      const double expected = CrpsOfNormal(z * sd, sd);
      EXPECT_NEAR(EnergyScore(VectorXd::Constant(1, z * sd), MatrixXd::Constant(1, 1, sd * sd)), expected,
                  1e-7 * expected)
          << sd << " " << z;
    }
  }
}

TEST(EnergyScore, MeanLengthOfANormalVectorIsTheKnownOne) {
  // sigma sqrt(2) Gamma((d + 1) / 2) / Gamma(d / 2).
  for (const int d : {1, 2, 3, 5}) {
    const double expected = 0.3 * std::numbers::sqrt2 * std::tgamma(0.5 * (d + 1)) / std::tgamma(0.5 * d);
    EXPECT_NEAR(MeanDistance(VectorXd::Constant(d, 0.09), VectorXd::Zero(d)), expected, 1e-8 * expected);
  }
}

TEST(EnergyScore, OfASingularCovarianceIsFinite) {
  const VectorXd e{{3.0, 0.0, 4.0, 0.0, 0.0}};
  EXPECT_NEAR(EnergyScore(e, MatrixXd::Zero(5, 5)), 5.0, 5e-7);
  EXPECT_EQ(EnergyScore(VectorXd::Zero(5), MatrixXd::Zero(5, 5)), 0.0);
  MatrixXd along_one = MatrixXd::Zero(5, 5);
  along_one(1, 1) = 0.04;
  EXPECT_NEAR(EnergyScore(VectorXd{{0.0, 0.3, 0.0, 0.0, 0.0}}, along_one), CrpsOfNormal(0.3, 0.2), 1e-8);
}

TEST(EnergyScore, IsThatOfDraws) {
  // 8 covariances and errors; the mean of |X - e| - |X - X'| / 2 over 100,000 pairs within 4.5 standard
  // errors: a false alarm in 8 * 7e-6.
  RandomStream rng({.seed = 3, .purpose = 91});
  for (int c = 0; c < 8; ++c) {
    const MatrixXd covariance = DrawScaledCovariance(&rng, c % 2 == 0 ? 1.0 : 1e-3);
    const MatrixXd root = covariance.llt().matrixL();
    const auto draw = [&] {
      VectorXd z(5);
      for (int i = 0; i < 5; ++i) z(i) = rng.Normal();
      return VectorXd(root * z);
    };
    const VectorXd e = 1.5 * draw();
    double sum = 0.0, squares = 0.0;
    constexpr int kNumPairs = 100'000;
    for (int k = 0; k < kNumPairs; ++k) {
      const VectorXd x = draw();
      const double score = (x - e).norm() - 0.5 * (x - draw()).norm();
      sum += score, squares += score * score;
    }
    const double mean = sum / kNumPairs, sd = std::sqrt(squares / kNumPairs - mean * mean);
    EXPECT_NEAR(EnergyScore(e, covariance), mean, 4.5 * sd / std::sqrt(1.0 * kNumPairs)) << c;
  }
}

TEST(NormalScores, AreBestForTheTrueDensity) {
  // 5,000 errors from N(0, Sigma), scored by densities whose sds are 0.7, 1 and 1.4 times as large.
  RandomStream rng({.seed = 3, .purpose = 92});
  const MatrixXd covariance = DrawScaledCovariance(&rng, 0.1), root = covariance.llt().matrixL();
  double energy[3] = {}, log_score[3] = {};
  for (int k = 0; k < 5'000; ++k) {
    VectorXd z(5);
    for (int i = 0; i < 5; ++i) z(i) = rng.Normal();
    const VectorXd e = root * z;
    int which = 0;
    for (const double scale : {0.7, 1.0, 1.4}) {
      const MatrixXd stated = scale * scale * covariance;
      energy[which] += EnergyScore(e, stated);
      log_score[which++] += LogScore(NormalizedErrorSquared(e, stated), LogDeterminant(stated), 5);
    }
  }
  EXPECT_LT(energy[1], energy[0]);
  EXPECT_LT(energy[1], energy[2]);
  EXPECT_LT(log_score[1], log_score[0]);
  EXPECT_LT(log_score[1], log_score[2]);
}

TEST(LogScore, IsThatOfScipy) {
  // python3 -c "from scipy.stats import multivariate_normal as m
  // print(-m([0, 0, 0], [[4, 1, .5], [1, 3, .2], [.5, .2, 2]]).logpdf([1, 2, -1]))"
  const MatrixXd covariance{{4.0, 1.0, 0.5}, {1.0, 3.0, 0.2}, {0.5, 0.2, 2.0}};
  const VectorXd e{{1.0, 2.0, -1.0}};
  EXPECT_NEAR(LogScore(NormalizedErrorSquared(e, covariance), LogDeterminant(covariance), 3),
              5.32304096189433, 1e-12);
  EXPECT_TRUE(std::isnan(LogDeterminant(MatrixXd::Zero(3, 3)))) << "no density";
}

}  // namespace
}  // namespace rcme
