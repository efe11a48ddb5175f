#include "estimator/calibrated/unstated_errors.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "stats/random.h"

namespace rcme {
namespace {

using Errors = Eigen::Vector4d;
using Derivatives = Eigen::Matrix<double, Eigen::Dynamic, 4>;

// Residuals r = J dp + G theta + N(0, I) of a linear problem.
struct LinearProblem {
  Eigen::Matrix<double, Eigen::Dynamic, 5> J;
  Derivatives G;
};

LinearProblem MakeLinearProblem(int num_residuals, RandomStream& rng) {
  LinearProblem problem{Eigen::MatrixXd(num_residuals, 5), Derivatives(num_residuals, 4)};
  for (int i = 0; i < num_residuals; ++i) {
    for (int k = 0; k < 5; ++k) problem.J(i, k) = rng.Normal();
    // Of the errors one cannot be seen, for it acts as a motion does.
    for (int k = 0; k < 4; ++k) problem.G(i, k) = k == 3 ? 2.0 * problem.J(i, 0) : 0.3 * rng.Normal();
  }
  return problem;
}

// The quantities of the check without the bound of a uniform motion: U = 0.
IntrinsicsCheck CheckLinear(const LinearProblem& problem, const Eigen::VectorXd& r) {
  const auto& [J, G] = problem;
  const Eigen::MatrixXd M = (J.transpose() * J).ldlt().solve(J.transpose() * G);
  const Eigen::MatrixXd rest = G - J * M;
  IntrinsicsCheck check;
  check.information = G.transpose() * rest;
  check.score = rest.transpose() * r;
  check.of_motion = -M;
  return check;
}

Eigen::VectorXd DrawNormals(Eigen::Index size, RandomStream& rng) {
  Eigen::VectorXd z(size);
  for (double& one : z) one = rng.Normal();
  return z;
}

// ln N(r; 0, covariance) but for a constant.
double LogDensity(const Eigen::VectorXd& r, const Eigen::MatrixXd& covariance) {
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
  return -0.5 * r.dot(llt.solve(r)) - llt.matrixLLT().diagonal().array().log().sum();
}

// With a vague prior N(0, s^2 I) of dp, r is N(0, I + s^2 J J') without errors, and with them there is G G'
// in addition. This does not use the formulas of the header.
TEST(UnstatedErrors, FactorIsTheRatioOfTheDensitiesOfTheResiduals) {
  constexpr double kVagueSd = 1e3, kPrior = 0.3;
  RandomStream rng({.seed = 1, .purpose = 2846});
  for (int trial = 0; trial < 20; ++trial) {
    const LinearProblem problem = MakeLinearProblem(30, rng);
    const Eigen::VectorXd r = DrawNormals(30, rng) + (trial % 2) * problem.G * DrawNormals(4, rng);
    const Eigen::MatrixXd without =
        Eigen::MatrixXd::Identity(30, 30) + kVagueSd * kVagueSd * problem.J * problem.J.transpose();
    const double log_ratio =
        LogDensity(r, without + problem.G * problem.G.transpose()) - LogDensity(r, without);
    const double w = WeighUnstatedErrors(CheckLinear(problem, r), kPrior, 1.0).probability;
    EXPECT_NEAR(std::log(w / (1.0 - w)), std::log(kPrior / (1.0 - kPrior)) + log_ratio, 1e-3) << trial;
  }
}

// The moment about the fit without errors is that of the true motion, given the residuals: of draws with
// errors, mean (dp - fit)(dp - fit)' = E A + C. The element of the error that cannot be seen is most of it.
// The standard error of a mean of 4,000 squares is 2.2 %.
TEST(UnstatedErrors, MomentIsThatOfTheMotionAboutTheFit) {
  constexpr int kDraws = 4000;
  RandomStream rng({.seed = 1, .purpose = 2847});
  const LinearProblem problem = MakeLinearProblem(30, rng);
  const Matrix5d C = (problem.J.transpose() * problem.J).inverse();
  Matrix5d of_draws = Matrix5d::Zero(), stated = Matrix5d::Zero();
  for (int draw = 0; draw < kDraws; ++draw) {
    const Eigen::VectorXd r = DrawNormals(30, rng) + problem.G * DrawNormals(4, rng);
    const Vector5d fit = C * problem.J.transpose() * r;  // true: 0
    of_draws += fit * fit.transpose() / kDraws;
    stated += (C + WeighUnstatedErrors(CheckLinear(problem, r), 1.0, 1.0).moment) / kDraws;
  }
  for (int k = 0; k < 5; ++k) EXPECT_NEAR(of_draws(k, k) / stated(k, k), 1.0, 0.11) << k;
  EXPECT_GT(stated(0, 0), 20.0 * C(0, 0));
}

// Among draws of which half have errors, of those with a stated probability between two levels the stated
// share has them: within five standard errors.
TEST(UnstatedErrors, ProbabilityIsThatOfErrors) {
  constexpr int kDraws = 4000, kBins = 4;
  RandomStream rng({.seed = 1, .purpose = 2848});
  double stated[kBins] = {}, happened[kBins] = {}, variance[kBins] = {};
  for (int draw = 0; draw < kDraws; ++draw) {
    const LinearProblem problem = MakeLinearProblem(30, rng);
    const bool has_errors = draw % 2 == 0;
    Eigen::VectorXd r = DrawNormals(30, rng);
    if (has_errors) r += problem.G * DrawNormals(4, rng);
    const double w = WeighUnstatedErrors(CheckLinear(problem, r), 0.5, 1.0).probability;
    const int bin = std::min(static_cast<int>(w * kBins), kBins - 1);
    stated[bin] += w, happened[bin] += has_errors, variance[bin] += w * (1.0 - w);
  }
  for (int bin = 0; bin < kBins; ++bin) {
    EXPECT_GT(variance[bin], 20.0) << bin;
    EXPECT_NEAR(stated[bin], happened[bin], 5.0 * std::sqrt(variance[bin])) << bin;
  }
}

// As if every f residuals were one.
TEST(UnstatedErrors, VarianceFactorDividesTheEvidence) {
  RandomStream rng({.seed = 1, .purpose = 2849});
  const LinearProblem problem = MakeLinearProblem(30, rng);
  IntrinsicsCheck check = CheckLinear(problem, DrawNormals(30, rng));
  const UnstatedErrors tempered = WeighUnstatedErrors(check, 0.2, 4.0);
  check.information /= 4.0;
  check.score /= 4.0;
  const UnstatedErrors divided = WeighUnstatedErrors(check, 0.2, 1.0);
  EXPECT_NEAR(tempered.probability, divided.probability, 1e-12);
  EXPECT_LT((tempered.moment - divided.moment).norm(), 1e-12 * divided.moment.norm());
}

TEST(UnstatedErrors, NoneIfImpossibleCertainIfCertainNoneIfNotFinite) {
  RandomStream rng({.seed = 1, .purpose = 2850});
  const LinearProblem problem = MakeLinearProblem(30, rng);
  IntrinsicsCheck check = CheckLinear(problem, DrawNormals(30, rng));
  EXPECT_EQ(WeighUnstatedErrors(check, 0.0, 1.0).probability, 0.0);
  EXPECT_EQ(WeighUnstatedErrors(check, 1.0, 1.0).probability, 1.0);
  check.score(0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(WeighUnstatedErrors(check, 0.5, 1.0).probability, 0.0);
  EXPECT_TRUE(WeighUnstatedErrors(check, 0.5, 1.0).moment.isZero());
}

}  // namespace
}  // namespace rcme
