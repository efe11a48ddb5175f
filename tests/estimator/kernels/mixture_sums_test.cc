// The sums against the scalar twin and numeric differences, on every instruction set.
#include "estimator/kernels/mixture_sums.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "estimator/calibrated/match_terms.h"
#include "estimator/noise_scale.h"
#include "tests/test_support/calibrated_mode.h"
#include "tests/test_support/every_target.h"
#include "tests/test_support/numeric_jacobian.h"

namespace rcme {
namespace {

class MixtureSumsOf : public OnEveryTarget {};

constexpr int kMixtureSizes[] = {1, 5, 7, 8, 9, 15, 16, 17, 63, 65, 200};

// Noise, wrong matches, some of them left out, and a motion a little beside the truth.
struct MixtureProblem {
  MotionProblem problem;
  RelativePose pose;
  MixtureParameters parameters;
  std::vector<int> used;
  MixtureSums Sum(const RelativePose& at) const {
    const MatchBlocks matches(problem);
    return SumMixture(matches, MakeMask(used, matches), at, parameters);
  }
};

// Matches that are all alike, or up to three times as noisy as others.
constexpr bool kNoises[] = {false, true};

MixtureProblem MakeMixtureProblem(int num_matches, bool is_scaled = false, double off_rad = 0.002) {
  RandomStream rng({.seed = 1, .trial = static_cast<std::uint32_t>(num_matches), .purpose = 2710});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = num_matches});
  AddNoise(0.5, rng, &random.problem);
  Vector5d off;
  for (double& x : off) x = off_rad * rng.Normal();
  MixtureProblem c{random.problem, Retract(random.pose_true, off), {}, {}};
  c.parameters.scale = 1.2;
  c.parameters.inlier_ratio = 0.65;
  c.parameters.outlier_density = 3e-3;
  for (int i = 0; i < num_matches; ++i) {
    Correspondence& match = c.problem.matches[static_cast<size_t>(i)];
    if (rng.Uniform() < 0.2) match.x2_px += 20.0 * Eigen::Vector2d(rng.Normal(), rng.Normal());
    if (i == 0 || rng.Uniform() < 0.8) c.used.push_back(i);
  }
  for (int i = 0; is_scaled && i < num_matches; ++i) c.problem.noise_scale.push_back(rng.Uniform(0.4, 3.0));
  return c;
}

MatchTerms ComputeTerms(const MixtureProblem& c, size_t i) {
  return EvaluateMatch(c.problem, c.pose, c.problem.matches[i], NoiseScaleAt(c.problem, i));
}

MixtureSums ScalarSums(const MixtureProblem& c) {
  MixtureSums sums;
  const double s2 = c.parameters.scale * c.parameters.scale;
  for (const int i : c.used) {
    const MatchTerms terms = ComputeTerms(c, static_cast<size_t>(i));
    const double scale = NoiseScaleAt(c.problem, static_cast<size_t>(i));
    const MatchDensity d = EvaluateDensity(terms.residual, terms.depth, c.parameters, scale);
    sums.log_likelihood += std::log(d.density);
    sums.num_right += d.right;
    sums.sum_squares += d.right * d.weight * terms.residual * terms.residual;
    const bool is_near = std::abs(terms.residual * scale) <= kNearResidual;
    sums.num_wrong_near += is_near ? 1.0 - d.right : 0.0;
    sums.gradient += d.right * d.weight * terms.residual / s2 * terms.derivative;
    sums.hessian += d.curvature / s2 * terms.derivative * terms.derivative.transpose();
  }
  return sums;
}

TEST_F(MixtureSumsOf, EqualTheScalarTwin) {
  for (const bool is_scaled : kNoises)
    for (const int n : kMixtureSizes) {
      const MixtureProblem c = MakeMixtureProblem(n, is_scaled);
      const MixtureSums expected = ScalarSums(c);
      ASSERT_GT(expected.gradient.norm(), 0.0);
      Run([&] {
        const MixtureSums sums = c.Sum(c.pose);
        EXPECT_NEAR(sums.log_likelihood, expected.log_likelihood, 1e-9 * n) << n;
        EXPECT_NEAR(sums.num_right, expected.num_right, 1e-9 * n) << n;
        EXPECT_NEAR(sums.sum_squares, expected.sum_squares, 1e-9 * n) << n;
        EXPECT_NEAR(sums.num_wrong_near, expected.num_wrong_near, 1e-9 * n) << n;
        EXPECT_JACOBIAN_NEAR(sums.gradient, expected.gradient, 1e-9) << n;
        EXPECT_JACOBIAN_NEAR(sums.hessian, expected.hessian, 1e-9) << n;
      });
    }
}

TEST_F(MixtureSumsOf, AreTheSameBitsOnEveryInstructionSet) {
  for (const bool is_scaled : kNoises)
    for (const int n : kMixtureSizes) {
      const MixtureProblem c = MakeMixtureProblem(n, is_scaled);
      const MatchBlocks matches(c.problem);
      std::optional<MixtureSums> first;
      std::optional<MatchTermLists> first_terms;
      double first_sum = 0.0;
      Run([&] {
        const MixtureSums sums = c.Sum(c.pose);
        MatchTermLists terms;
        EvaluateTerms(matches, c.pose, &terms);
        const double cheirality = SumCheirality(matches, 100, c.pose, 2.5);
        if (!first) {
          first = sums;
          first_terms = terms;
          first_sum = cheirality;
        }
        EXPECT_EQ(sums.log_likelihood, first->log_likelihood);
        EXPECT_EQ(sums.num_right, first->num_right);
        EXPECT_EQ(sums.sum_squares, first->sum_squares);
        EXPECT_EQ(sums.num_wrong_near, first->num_wrong_near);
        EXPECT_EQ(sums.gradient, first->gradient);
        EXPECT_EQ(sums.hessian, first->hessian);
        EXPECT_EQ(cheirality, first_sum);
        for (size_t i = 0; i < static_cast<size_t>(n); ++i) {  // padding means nothing, and may be NaN
          EXPECT_EQ(terms.residual[i], first_terms->residual[i]);
          EXPECT_EQ(terms.depth[i], first_terms->depth[i]);
          for (size_t k = 0; k < 5; ++k) EXPECT_EQ(terms.derivative[k][i], first_terms->derivative[k][i]);
        }
      });
    }
}

TEST_F(MixtureSumsOf, EachAloneHasTheBitsThatItHasAmongAll) {
  for (const bool is_scaled : kNoises)
    for (const int n : kMixtureSizes) {
      const MixtureProblem c = MakeMixtureProblem(n, is_scaled);
      const MatchBlocks matches(c.problem);
      const MatchMask mask = MakeMask(c.used, matches);
      Run([&] {
        const MixtureSums all = c.Sum(c.pose);
        EXPECT_EQ(SumMixtureGradient(matches, mask, c.pose, c.parameters), all.gradient);
        EXPECT_EQ(SumLogLikelihood(matches, mask, c.pose, c.parameters), all.log_likelihood);
      });
    }
}

TEST_F(MixtureSumsOf, ListsOfTheFirstMatchesAreThoseOfAllCutShort) {
  const MixtureProblem c = MakeMixtureProblem(65);
  const MatchBlocks matches(c.problem);
  Run([&] {
    MatchTermLists all, first;
    EvaluateTerms(matches, c.pose, &all);
    EvaluateTerms(matches, c.pose, &first, 20);
    ASSERT_EQ(first.residual.size(), 24U);
    all.residual.resize(24);
    all.derivative[4].resize(24);
    EXPECT_EQ(first.residual, all.residual);
    EXPECT_EQ(first.derivative[4], all.derivative[4]);
  });
}

TEST_F(MixtureSumsOf, ListsHoldTheTermsOfEveryMatch) {
  for (const bool is_scaled : kNoises)
    for (const int n : kMixtureSizes) {
      const MixtureProblem c = MakeMixtureProblem(n, is_scaled);
      Run([&] {
        MatchTermLists lists;
        EvaluateTerms(MatchBlocks(c.problem), c.pose, &lists);
        ASSERT_EQ(lists.residual.size(), static_cast<size_t>((n + 7) / 8 * 8));
        for (size_t i = 0; i < static_cast<size_t>(n); ++i) {
          const MatchTerms terms = ComputeTerms(c, i);
          EXPECT_NEAR(lists.residual[i], terms.residual, 1e-8);
          EXPECT_NEAR(lists.depth[i], terms.depth, 1e-8 * (1.0 + std::abs(terms.depth)));
          Vector5d derivative;
          for (size_t k = 0; k < 5; ++k) derivative(static_cast<Eigen::Index>(k)) = lists.derivative[k][i];
          EXPECT_JACOBIAN_NEAR(derivative, terms.derivative, 1e-9);
        }
      });
    }
}

// The density of r is that of r' over w (mixture_parameters.h): integrated over all r, right and wrong
// matches give what they do without scales, and the likelihood of r' is that of r plus sum log w.
TEST_F(MixtureSumsOf, AreOfTheDensityOfResidualsThatAreScaled) {
  MixtureParameters m;
  m.scale = 0.8;
  m.inlier_ratio = 0.7;
  for (const double w : {0.3, 1.0, 4.0}) {
    double sum = 0.0;
    constexpr double kStep = 0.002, kReach = 50.0;
    for (double r = -kReach; r <= kReach; r += kStep)
      sum += EvaluateDensity(r / w, 5.0, m, w).density / w * kStep;
    const double wrong = (1.0 - m.inlier_ratio) * m.outlier_density * 2.0 * kReach;
    EXPECT_NEAR(sum, m.inlier_ratio + wrong, 1e-3) << w;
  }
  // All noises doubled is all of them twice the assumed one: s is halved.
  MixtureProblem c = MakeMixtureProblem(65);
  MixtureProblem doubled = c;
  doubled.problem.noise_scale.assign(65, 2.0);
  doubled.parameters.scale *= 0.5;
  Run([&] {
    const MixtureSums one = c.Sum(c.pose), other = doubled.Sum(c.pose);
    EXPECT_NEAR(other.log_likelihood - static_cast<double>(c.used.size()) * std::log(2.0), one.log_likelihood,
                1e-9);
    EXPECT_NEAR(other.num_right, one.num_right, 1e-9);
    EXPECT_NEAR(other.num_wrong_near, one.num_wrong_near, 1e-9);
    EXPECT_NEAR(4.0 * other.sum_squares, one.sum_squares, 1e-9 * one.sum_squares);
    EXPECT_JACOBIAN_NEAR(other.gradient, one.gradient, 1e-9);
    EXPECT_JACOBIAN_NEAR(other.hessian, one.hessian, 1e-9);
  });
}

// Ones give the bytes that no scales give.
TEST_F(MixtureSumsOf, ScalesOfOneChangeNothing) {
  const MixtureProblem c = MakeMixtureProblem(65);
  MixtureProblem ones = c;
  ones.problem.noise_scale.assign(65, 1.0);
  Run([&] {
    const MixtureSums none = c.Sum(c.pose), one = ones.Sum(c.pose);
    EXPECT_EQ(one.log_likelihood, none.log_likelihood);
    EXPECT_EQ(one.num_wrong_near, none.num_wrong_near);
    EXPECT_EQ(one.gradient, none.gradient);
    EXPECT_EQ(one.hessian, none.hessian);
  });
}

TEST_F(MixtureSumsOf, MatchesOutsideTheMaskAddNothing) {
  MixtureProblem c = MakeMixtureProblem(41);
  std::erase_if(c.used, [](int i) { return i % 8 == 3 || i >= 37; });
  MixtureProblem other = c;
  for (size_t i = 0; i < 41; ++i) {
    if (i % 8 == 3 || i >= 37) other.problem.matches[i].x2_px.array() += 1e5;
  }
  Run([&] {
    const MixtureSums before = c.Sum(c.pose), after = other.Sum(c.pose);
    EXPECT_EQ(after.log_likelihood, before.log_likelihood);
    EXPECT_EQ(after.gradient, before.gradient);
    EXPECT_EQ(after.hessian, before.hessian);
  });
}

// The logarithm is taken of products of densities, which must not run on where blocks of eight are empty:
// here every eighth one is, and each density is some 1e-3.
TEST_F(MixtureSumsOf, EmptyBlocksDoNotLetProductsVanish) {
  MixtureProblem c = MakeMixtureProblem(2000);
  std::erase_if(c.used, [](int i) { return i / 8 % 8 == 7; });
  c.parameters.inlier_ratio = 0.01;
  const double expected = ScalarSums(c).log_likelihood;
  Run([&] { EXPECT_NEAR(c.Sum(c.pose).log_likelihood, expected, 1e-6); });
}

// c(z) is held fixed by the gradient: here it is one for every match, at every pose near by.
TEST_F(MixtureSumsOf, TheGradientIsThatOfTheLogLikelihood) {
  for (const bool is_scaled : kNoises) {
    MixtureProblem c = MakeMixtureProblem(65, is_scaled);
    std::erase_if(c.used, [&](int i) { return ComputeTerms(c, static_cast<size_t>(i)).depth < 1.0; });
    ASSERT_GT(c.used.size(), 30U);
    const Eigen::MatrixXd numeric = NumericJacobian(
        [&](const Eigen::VectorXd& tangent) {
          return Eigen::VectorXd::Constant(1, -c.Sum(Retract(c.pose, tangent)).log_likelihood);
        },
        Vector5d::Zero(), 1e-6);
    Run([&] { EXPECT_JACOBIAN_NEAR(c.Sum(c.pose).gradient.transpose(), numeric, 1e-5); });
  }
}

// Without noise, at the true motion, the terms r'' r vanish and no bound is touched.
TEST_F(MixtureSumsOf, TheHessianIsThatOfTheLogLikelihoodWhereResidualsAreSmall) {
  RandomStream rng({.seed = 1, .purpose = 2711});
  const RandomProblem random = MakeRandomProblem(rng, {.num_matches = 50});
  MixtureProblem c{random.problem, random.pose_true, {}, {}};
  for (int i = 0; i < 50; ++i) c.used.push_back(i);
  const auto cost = [&](const Eigen::VectorXd& tangent) {
    return Eigen::VectorXd::Constant(1, -c.Sum(Retract(c.pose, tangent)).log_likelihood);
  };
  const Eigen::MatrixXd numeric = NumericJacobian(
      [&](const Eigen::VectorXd& at) -> Eigen::VectorXd {
        return NumericJacobian(cost, at, 2e-5).transpose();
      },
      Vector5d::Zero(), 2e-5);
  Run([&] { EXPECT_JACOBIAN_NEAR(c.Sum(c.pose).hessian, numeric, 1e-3); });
}

TEST_F(MixtureSumsOf, CheiralityTurnsOverWithTheDirection) {
  for (const bool is_scaled : kNoises)
    for (const int n : kMixtureSizes) {
      const MixtureProblem c = MakeMixtureProblem(n, is_scaled);
      const MatchBlocks matches(c.problem);
      double expected = 0.0;
      const int num_blocks = std::max(matches.num_blocks() - 1, 1);
      for (int i = 0; i < std::min(n, 8 * num_blocks); ++i) {
        const MatchTerms terms = ComputeTerms(c, static_cast<size_t>(i));
        expected += SoftScore(terms.residual, 2.5) * terms.mean_depth / std::hypot(1.0, terms.mean_depth);
      }
      RelativePose opposite = c.pose;
      opposite.t = -opposite.t;
      Run([&] {
        const double sum = SumCheirality(matches, num_blocks, c.pose, 2.5);
        EXPECT_NEAR(sum, expected, 1e-8) << n;
        EXPECT_NEAR(SumCheirality(matches, num_blocks, opposite, 2.5), -sum, 1e-12) << n;
      });
    }
}

}  // namespace
}  // namespace rcme
