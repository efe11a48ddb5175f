#include "estimator/calibrated/unstated_errors.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "estimator/calibrated/mode_covariance.h"
#include "estimator/uncertainty/calibration_prior.h"
#include "stats/random.h"
#include "tests/test_support/calibrated_mode.h"

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
IntrinsicsEvidence CheckLinear(const LinearProblem& problem, const Eigen::VectorXd& r) {
  const auto& [J, G] = problem;
  const Eigen::MatrixXd M = (J.transpose() * J).ldlt().solve(J.transpose() * G);
  const Eigen::MatrixXd rest = G - J * M;
  IntrinsicsEvidence check;
  check.information = G.transpose() * rest;
  check.score = rest.transpose() * r;
  check.of_motion = -M;
  check.stated_sd.setZero(4);
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
    const double w = WeighUnstatedErrors(CheckLinear(problem, r), kPrior).probability;
    EXPECT_NEAR(std::log(w / (1.0 - w)), std::log(kPrior / (1.0 - kPrior)) + log_ratio, 1e-3) << trial;
  }
}

// An error that is stated is there in both cases, whatever its size: the residuals that it explains are no
// evidence of others. Without the stated ones in both densities the factor would be e^100 and more.
TEST(UnstatedErrors, StatedErrorsAreNoEvidence) {
  constexpr double kVagueSd = 1e3, kPrior = 0.3;
  RandomStream rng({.seed = 1, .purpose = 2852});
  for (int trial = 0; trial < 20; ++trial) {
    const LinearProblem problem = MakeLinearProblem(30, rng);
    const double sd = 20.0;
    Errors theta = sd * rng.Normal() * Errors::Unit(1);
    if (trial % 2 == 1) theta(0) = 3.0 * rng.Normal();
    const Eigen::VectorXd r = DrawNormals(30, rng) + problem.G * theta;
    const Eigen::MatrixXd without = Eigen::MatrixXd::Identity(30, 30) +
                                    kVagueSd * kVagueSd * problem.J * problem.J.transpose() +
                                    sd * sd * problem.G.col(1) * problem.G.col(1).transpose();
    Eigen::MatrixXd with = without;
    for (const int k : {0, 2, 3}) with += problem.G.col(k) * problem.G.col(k).transpose();
    IntrinsicsEvidence evidence = CheckLinear(problem, r);
    evidence.stated_sd(1) = sd;
    const UnstatedErrors errors = WeighUnstatedErrors(evidence, kPrior);
    const double w = errors.probability;
    EXPECT_NEAR(std::log(w / (1.0 - w)),
                std::log(kPrior / (1.0 - kPrior)) + LogDensity(r, with) - LogDensity(r, without), 2e-3)
        << trial;
    // Of the others alone.
    evidence.of_motion.col(1).setConstant(1e3);
    EXPECT_EQ(WeighUnstatedErrors(evidence, kPrior).Moment(), errors.Moment());
  }
}

// Against draws of the motion from both laws, weighed by the density of the prior's residuals.
TEST(UnstatedErrors, ByAPriorAreThoseOfWeighedDraws) {
  constexpr int kDraws = 400000;
  RandomStream rng({.seed = 1, .purpose = 2853});
  for (const double offset : {0.0, 1.0, 2.0}) {
    Matrix5d root = Matrix5d::Zero(), wide = Matrix5d::Zero();
    for (double& x : root.reshaped()) x = 0.3 * rng.Normal();
    for (double& x : wide.reshaped()) x = 0.6 * rng.Normal();
    root += Matrix5d::Identity();
    const Matrix5d C = root * root.transpose();
    const UnstatedErrors before{0.2, 0.3 * Vector5d::Ones(), wide * wide.transpose()};
    PriorResiduals at_optimum;  // of the matches: rows of a rotation, and of a direction of rank two
    for (const int row : {0, 1, 2, 6, 7}) {
      at_optimum.residual(row) = offset * rng.Normal();
      for (int k = 0; k < 5; ++k) at_optimum.jacobian(row, k) = rng.Normal();
    }
    const auto& J = at_optimum.jacobian;
    const Matrix5d posterior = (C.inverse() + J.transpose() * J).inverse();
    const Vector5d answer = -posterior * J.transpose() * at_optimum.residual;
    PriorResiduals at_answer = at_optimum;
    at_answer.residual += J * answer;
    const UnstatedErrors after = UpdateByPrior(before, C, at_answer);
    const Matrix5d with_errors = (C + before.spread).llt().matrixL();
    const Matrix5d without = C.llt().matrixL();
    double weight[2] = {};
    Matrix5d moment = Matrix5d::Zero();
    for (int draw = 0; draw < kDraws; ++draw) {
      const int errs = draw % 2;
      const Vector5d z = DrawNormals(5, rng);
      const Vector5d motion = errs ? Vector5d(before.shift + with_errors * z) : Vector5d(without * z);
      const double density = std::exp(-0.5 * (at_optimum.residual + J * motion).squaredNorm());
      weight[errs] += density;
      if (errs) moment += density * (motion - answer) * (motion - answer).transpose();
    }
    const double odds = before.probability / (1.0 - before.probability) * weight[1] / weight[0];
    EXPECT_NEAR(after.probability / (1.0 - after.probability) / odds, 1.0, 0.1) << offset;
    moment /= weight[1];
    EXPECT_LT((posterior + after.Moment() - moment).norm(), 0.1 * moment.norm()) << offset;
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
    stated += (C + WeighUnstatedErrors(CheckLinear(problem, r), 1.0).Moment()) / kDraws;
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
    const double w = WeighUnstatedErrors(CheckLinear(problem, r), 0.5).probability;
    const int bin = std::min(static_cast<int>(w * kBins), kBins - 1);
    stated[bin] += w, happened[bin] += has_errors, variance[bin] += w * (1.0 - w);
  }
  for (int bin = 0; bin < kBins; ++bin) {
    EXPECT_GT(variance[bin], 20.0) << bin;
    EXPECT_NEAR(stated[bin], happened[bin], 5.0 * std::sqrt(variance[bin])) << bin;
  }
}

TEST(UnstatedErrors, NoneIfImpossibleCertainIfCertainNoneIfNotFinite) {
  RandomStream rng({.seed = 1, .purpose = 2850});
  const LinearProblem problem = MakeLinearProblem(30, rng);
  IntrinsicsEvidence check = CheckLinear(problem, DrawNormals(30, rng));
  EXPECT_EQ(WeighUnstatedErrors(check, 0.0).probability, 0.0);
  EXPECT_EQ(WeighUnstatedErrors(check, 1.0).probability, 1.0);
  check.score(0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(WeighUnstatedErrors(check, 0.5).probability, 0.0);
  EXPECT_TRUE(WeighUnstatedErrors(check, 0.5).Moment().isZero());
}

// The bound of a uniform motion is applied once: errors make no variance smaller, however weak the direction.
TEST(UnstatedErrors, NeverNarrow) {
  UnstatedErrors errors{.probability = 0.3, .spread = 1e-4 * Matrix5d::Identity()};
  for (const double variance : {1e-4, 0.1, 1.0, 10.0}) {
    const Matrix5d covariance = variance * Matrix5d::Identity();
    const Matrix5d wider = errors.MixInto(covariance) - BoundByUniformMotion(covariance);
    EXPECT_GT(wider.diagonal().minCoeff(), 0.0) << variance;
  }
  errors.probability = 0.0;
  EXPECT_EQ(errors.MixInto(Matrix5d::Identity()), BoundByUniformMotion(Matrix5d::Identity()));
}

// -M turns errors into the motion's: its squares are the variances of CalibrationCovariance (finite
// differences of the cost) for the usual errors, whatever the lens and the pixels. The two use different
// Hessians, so that single ones differ by up to a third; on average over 25 the logarithms of their roots
// differ by .06. With the derivatives of a pinhole in the pixels of the problem they would by .25 and more.
struct LensCase {
  const char* name;
  LensModel model;
  bool is_turned;
};
class UnstatedErrorsOf : public testing::TestWithParam<LensCase> {};

TEST_P(UnstatedErrorsOf, LensesAndPixelsMoveTheMotionAsStatedErrorsDo) {
  constexpr int kTrials = 5;
  double off = 0.0, off_of_pinhole = 0.0, off_of_k1 = 0.0, off_of_pinholes_k1 = 0.0;
  for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
    FittedMode f = FitScene(200, 0.1, 0.0, trial);
    CalibrationPrior usual{.focal_sd = 0.014, .principal_point_sd_px = 4.7, .distortion_sd = 0.023};
    if (GetParam().model != LensModel::kPinhole) {
      const Lens lens1{f.problem.camera1, GetParam().model, {0.3, 0.1, 0.0, 0.0}};
      const Lens lens2{f.problem.camera2, GetParam().model, {0.2, 0.1, 0.0, 0.0}};
      f.problem.undistortion = Undistortion{lens1, lens2, 1.0};
    }
    if (GetParam().is_turned) {
      usual.of_pixels1 << 0.8, -0.7, 0.5, 1.1;
      usual.of_pixels2 << 1.2, 0.1, -0.3, 2.9;
    }
    const Explanation explanation = Explain(f.matches, f.mode);
    const Matrix5d curvature = InverseOfObserved(f.matches, f.mode);
    const auto distance = [&](const CalibrationPrior& errors, const MotionProblem& seen,
                              const CalibrationPrior& stated) {
      const IntrinsicsEvidence evidence = FindIntrinsicsEvidence(seen, f.mode, explanation, stated);
      const IntrinsicsEvidence::Vector is_unstated = (evidence.stated_sd.array() == 0.0).cast<double>();
      const Vector5d found = (evidence.of_motion * is_unstated.asDiagonal()).rowwise().squaredNorm();
      const Vector5d expected = IntrinsicsCovariance(f.problem, errors, f.mode, curvature).diagonal();
      return 0.5 * (found.array() / expected.array()).log().abs().mean() / kTrials;
    };
    CalibrationPrior none = usual;
    none.focal_sd = none.principal_point_sd_px = none.distortion_sd = 0.0;
    off += distance(usual, f.problem, none);
    MotionProblem pinhole = f.problem;
    pinhole.undistortion.reset();
    off_of_pinhole += distance(usual, pinhole, {});
    CalibrationPrior all_but_k1 = usual, k1 = usual;
    all_but_k1.distortion_sd = k1.focal_sd = k1.principal_point_sd_px = 0.0;
    off_of_k1 += distance(k1, f.problem, all_but_k1);
    off_of_pinholes_k1 += distance(k1, pinhole, all_but_k1);
    EXPECT_TRUE(FindIntrinsicsEvidence(f.problem, f.mode, explanation, usual)
                    .stated_sd.isApproxToConstant(1.0, 1e-12));
  }
  EXPECT_LT(off, 0.09);
  EXPECT_LT(off_of_k1, 0.09);
  if (GetParam().is_turned) {
    EXPECT_GT(off_of_pinhole, 0.13);
  } else if (GetParam().model != LensModel::kPinhole) {
    EXPECT_GT(off_of_pinholes_k1, 0.13);
  }
}

INSTANTIATE_TEST_SUITE_P(All, UnstatedErrorsOf,
                         testing::Values(LensCase{"pinhole", LensModel::kPinhole, false},
                                         LensCase{"turned", LensModel::kPinhole, true},
                                         LensCase{"radtan", LensModel::kRadtan, false},
                                         LensCase{"fisheye", LensModel::kFisheye, false}),
                         [](const auto& of) { return of.param.name; });

}  // namespace
}  // namespace rcme
