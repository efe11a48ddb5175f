// The equations of the refinement, one match at a time (refinement/) and many at a time (kernels/), against
// each other on every instruction set: the sums to rounding, and the motions that the one search finds with
// either.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "estimator/kernels/block_matches.h"
#include "estimator/kernels/rotation_equations.h"
#include "estimator/kernels/sampson_equations.h"
#include "estimator/observability.h"
#include "estimator/reference_matches.h"
#include "estimator/refinement/sampson_equations.h"
#include "tests/test_support/every_target.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

class EquationsAgreement : public OnEveryTarget {};

constexpr Loss kLosses[] = {Loss::kSquared, Loss::kCauchy};
constexpr int kEquationCounts[] = {5, 6, 8, 9, 17, 64, 200};

// Noisy matches of two different cameras, one in six wrong, four in five of them used.
struct StartProblem {
  MotionProblem problem;
  RelativePose start;  // a little beside the truth
  std::vector<int> used;
};
StartProblem MakeStartProblem(int num_matches, std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2650});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = num_matches});
  AddNoise(0.5, rng, &random.problem);
  Vector5d off;
  for (double& x : off) x = 0.01 * rng.Normal();
  StartProblem c{random.problem, Retract(random.pose_true, off), {}};
  for (int i = 0; i < num_matches; ++i) {
    if (i % 6 == 4) c.problem.matches[static_cast<size_t>(i)].x2_px.y() += 20.0 * rng.Normal();
    if (num_matches < 8 || rng.Uniform() < 0.8) c.used.push_back(i);
  }
  return c;
}

// Far from every camera, so that a rotation explains the matches.
StartProblem MakeRotationProblem(std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2651});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = 61, .min_depth = 1e9, .max_depth = 2e9});
  AddNoise(0.5, rng, &random.problem);
  StartProblem c{random.problem, random.pose_true, {}};
  for (int i = 0; i < 61; ++i) {
    Correspondence& match = c.problem.matches[static_cast<size_t>(i)];
    if (i % 7 == 0) match.x2_px << rng.Uniform(0.0, 799.0), rng.Uniform(0.0, 599.0);
    if (i % 5 != 0) c.used.push_back(i);
  }
  return c;
}

// The gradient is a sum of terms of both signs; each rounds as its greatest, |gradient_k| <= sqrt(2 cost
// hessian_kk) up to the weights.
template <typename Vector, typename Matrix>
void ExpectSameSums(double cost, const Vector& gradient, const Matrix& hessian, double expected_cost,
                    const Vector& expected_gradient, const Matrix& expected_hessian) {
  constexpr double kRounding = 1e-11;
  EXPECT_NEAR(cost, expected_cost, kRounding * expected_cost);
  const Vector scale = expected_hessian.diagonal().cwiseSqrt();
  for (Eigen::Index k = 0; k < scale.size(); ++k) {
    EXPECT_NEAR(gradient(k), expected_gradient(k),
                kRounding * (std::sqrt(2.0 * expected_cost) * scale(k) + std::abs(expected_gradient(k))));
    for (Eigen::Index l = 0; l < scale.size(); ++l) {
      EXPECT_NEAR(hessian(k, l), expected_hessian(k, l), kRounding * scale(k) * scale(l));
    }
  }
}

void CompareSampson(const StartProblem& c, const RelativePose& pose) {
  for (const Loss loss : kLosses) {
    const NormalEquations expected = LinearizeSampson(c.problem, c.used, pose, loss);
    const Matrix5d information = SampsonInformation(c.problem, c.used, pose);
    RunOnEveryTarget([&] {
      const MatchBlocks matches(c.problem);
      const MatchMask mask = MakeMask(c.used, matches);
      const NormalEquations sums = LinearizeSampson(matches, mask, pose, loss);
      ExpectSameSums(sums.cost, sums.gradient, sums.hessian, expected.cost, expected.gradient,
                     expected.hessian);
      const Matrix5d block_information = SampsonInformation(matches, mask, pose);
      EXPECT_LT((block_information - information).norm(), 1e-11 * information.norm());
    });
  }
}

TEST_F(EquationsAgreement, SampsonSumsAreTheSame) {
  for (const int n : kEquationCounts) {
    for (std::uint32_t trial = 0; trial < 5; ++trial) {
      const StartProblem c = MakeStartProblem(n, trial);
      CompareSampson(c, c.start);
      CompareSampson(c, Retract(c.start, Vector5d::Constant(0.5)));  // residuals of hundreds of sigma
    }
  }
}

TEST_F(EquationsAgreement, TheSearchEndsAtTheSameMotion) {
  int num_converged = 0;
  for (const int n : {9, 17, 64, 200}) {
    for (std::uint32_t trial = 0; trial < 20; ++trial) {
      const StartProblem c = MakeStartProblem(n, trial);
      for (const Loss loss : kLosses) {
        const RefinedMotion expected = RefineBySampson(c.problem, c.used, c.start, loss);
        num_converged += expected.converged;
        Run([&] {
          const MatchBlocks matches(c.problem);
          const RefinedMotion motion = RefineBySampson(matches, MakeMask(c.used, matches), c.start, loss);
          ASSERT_EQ(motion.converged, expected.converged) << n << ", trial " << trial;
          EXPECT_EQ(motion.num_iterations, expected.num_iterations) << n << ", trial " << trial;
          EXPECT_LT(LocalCoordinates(expected.cam2_from_cam1, motion.cam2_from_cam1).norm(), 1e-9)
              << n << ", trial " << trial;
          EXPECT_LE((motion.pose_cov - expected.pose_cov).norm(), 1e-7 * expected.pose_cov.norm());
        });
      }
    }
  }
  EXPECT_GT(num_converged, 150);
}

// Six matches that are four different ones: the sums are of rank four in both.
TEST_F(EquationsAgreement, RankDeficientSumsAreTheSame) {
  StartProblem c = MakeStartProblem(6, 1);
  c.problem.matches[4] = c.problem.matches[0];
  c.problem.matches[5] = c.problem.matches[1];
  CompareSampson(c, c.start);
  const auto condition = [](const Matrix5d& information) {
    const Vector5d scale = information.diagonal().cwiseSqrt().cwiseInverse();
    const Matrix5d scaled = scale.asDiagonal() * information * scale.asDiagonal();
    const Vector5d values = Eigen::SelfAdjointEigenSolver<Matrix5d>(scaled).eigenvalues();
    return values(0) / values(4);
  };
  EXPECT_LT(std::abs(condition(SampsonInformation(c.problem, c.used, c.start))), 1e-13);
  Run([&] {
    const MatchBlocks matches(c.problem);
    EXPECT_LT(std::abs(condition(SampsonInformation(matches, matches.All(), c.start))), 1e-13);
  });
}

TEST_F(EquationsAgreement, FewerThanFiveMatchesConvergeInNeither) {
  const StartProblem c = MakeStartProblem(6, 1);
  const std::vector<int> four = {0, 1, 2, 5};
  const RefinedMotion reference = RefineBySampson(c.problem, four, c.start, Loss::kCauchy);
  const MatchBlocks matches(c.problem);
  const RefinedMotion block = RefineBySampson(matches, MakeMask(four, matches), c.start, Loss::kCauchy);
  for (const RefinedMotion& motion : {reference, block}) {
    EXPECT_FALSE(motion.converged);
    EXPECT_EQ(motion.cam2_from_cam1.R, c.start.R);
  }
}

// Rotations that leave all matches in front of camera 2, take some behind it, and all.
TEST_F(EquationsAgreement, RotationSumsAreTheSameWithMatchesBehindTheCamera) {
  int num_some_behind = 0, num_all_behind = 0;
  for (std::uint32_t trial = 0; trial < 6; ++trial) {
    const StartProblem c = MakeRotationProblem(trial);
    for (const double angle : {0.0, 0.01, 1.4, 3.1}) {
      const Eigen::Matrix3d R = RotationFromVector(angle * Eigen::Vector3d::UnitY()) * c.start.R;
      const auto num_in_front = FindRotated(c.problem, R, 1e300).size();
      num_some_behind += num_in_front > 0 && num_in_front < 61;
      num_all_behind += num_in_front == 0;
      for (const Loss loss : kLosses) {
        const RotationEquations expected = LinearizeRotation(c.problem, c.used, R, loss);
        Run([&] {
          const MatchBlocks matches(c.problem);
          const RotationEquations sums = LinearizeRotation(matches, MakeMask(c.used, matches), R, loss);
          ExpectSameSums(sums.energy, sums.gradient, sums.hessian, expected.energy, expected.gradient,
                         expected.hessian);
          const BlockMatches block(c.problem, matches, RefinementError::kSampson);
          for (const double threshold : {2.0, 20.0, 1e300}) {
            EXPECT_EQ(ListIndices(block.FindRotated(R, threshold)), FindRotated(c.problem, R, threshold));
          }
        });
      }
    }
  }
  EXPECT_GT(num_some_behind, 3);
  EXPECT_GT(num_all_behind, 3);
}

TEST_F(EquationsAgreement, TheTestOfARotationAloneDecidesTheSame) {
  int num_explained = 0, num_not = 0;
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const StartProblem c = trial % 2 == 0 ? MakeRotationProblem(trial) : MakeStartProblem(61, trial);
    const ReferenceMatches reference(c.problem, RefinementError::kSampson);
    const RotationTest expected = TestRotationAlone(reference, c.start, 0.001);
    ++(expected.explains_matches ? num_explained : num_not);
    Run([&] {
      const MatchBlocks matches(c.problem);
      const BlockMatches block(c.problem, matches, RefinementError::kSampson);
      const RotationTest test = TestRotationAlone(block, c.start, 0.001);
      EXPECT_EQ(test.explains_matches, expected.explains_matches) << trial;
      EXPECT_EQ(test.num_agreeing, expected.num_agreeing) << trial;
      EXPECT_EQ(test.num_beyond, expected.num_beyond) << trial;
      EXPECT_EQ(test.num_unexplained, expected.num_unexplained) << trial;
      // Where no rotation fits, the descent ends anywhere after its last step.
      if (!expected.explains_matches) return;
      EXPECT_LT(RotationAngleBetween(test.rotation.R, expected.rotation.R), 1e-9) << trial;
    });
  }
  EXPECT_GT(num_explained, 5);
  EXPECT_GT(num_not, 5);
}

}  // namespace
}  // namespace rcme
