// What every minimal solver of the table has to meet, on matches of a motion of its own family.
#include "estimator/solvers/minimal_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <limits>
#include <numeric>

#include "estimator/hypothesis.h"
#include "estimator/sample_consistency.h"
#include "estimator/solvers/solver_table.h"
#include "estimator/uncertainty/motion_covariance.h"
#include "stats/distributions.h"
#include "tests/test_support/coverage_count.h"
#include "tests/test_support/numeric_jacobian.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

// A turn of up to 20 deg about y and a step along the chord of its circle, by the cameras' places alone:
// camera 2 looks along (sin, 0, cos) of the yaw angle from the point (sin, 0, cos) of its half.
RelativePose RandomCarMotion(RandomStream& rng) {
  const double yaw = rng.Uniform(-0.35, 0.35);
  Eigen::Matrix3d cam1_from_cam2;
  cam1_from_cam2 << std::cos(yaw), 0.0, std::sin(yaw), 0.0, 1.0, 0.0, -std::sin(yaw), 0.0, std::cos(yaw);
  const Eigen::Vector3d place(std::sin(0.5 * yaw), 0.0, std::cos(0.5 * yaw));
  return {cam1_from_cam2.transpose(), -(cam1_from_cam2.transpose() * place)};
}

// Matches without noise of a motion that the solver can find.
template <typename Solver>
RandomProblem MakeProblemFor(RandomStream& rng, int num_matches) {
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = num_matches});
  if constexpr (!std::is_same_v<Solver, OnePoint>) return random;
  random.pose_true = RandomCarMotion(rng);
  for (size_t i = 0; i < random.problem.matches.size();) {
    const auto point = RandomPoint(random.pose_true, random.problem.camera1, random.problem.camera2, {}, rng);
    if (!point) continue;
    random.points_in_cam1[i] = *point;
    random.problem.matches[i++] =
        ProjectToBoth(*point, random.pose_true, random.problem.camera1, random.problem.camera2);
  }
  return random;
}

template <typename Solver>
Sample FirstMatches() {
  Sample sample(Solver::kSampleSize);
  std::iota(sample.begin(), sample.end(), 0);
  return sample;
}

template <typename Solver>
struct SampleRays {
  typename Solver::Rays first, second;
};
template <typename Solver>
SampleRays<Solver> ComputeSampleRays(const MotionProblem& problem) {
  SampleRays<Solver> rays;
  for (size_t k = 0; k < rays.first.size(); ++k) {
    rays.first[k] = problem.camera1.Ray(problem.matches[k].x1_px);
    rays.second[k] = problem.camera2.Ray(problem.matches[k].x2_px);
  }
  return rays;
}

double Distance(const Vector9d& f, const Vector9d& other) {
  return std::min((f - other).norm(), (f + other).norm());
}

// The hypothesis whose motion is nearest to the truth, with that one of its four motions.
template <typename Solver>
std::optional<Hypothesis<Solver>> NearestHypothesis(const RandomProblem& random) {
  std::optional<Hypothesis<Solver>> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (Hypothesis<Solver> hypothesis : InstantiateModels<Solver>(random.problem, FirstMatches<Solver>())) {
    for (const RelativePose& pose : PosesFromEssential(hypothesis.projection)) {
      const double distance = LocalCoordinates(pose, random.pose_true).norm();
      if (distance >= least) continue;
      least = distance;
      hypothesis.pose = pose;
      nearest = hypothesis;
    }
  }
  if (nearest) PropagateCovariance(random.problem, &*nearest);
  return nearest;
}

template <typename Solver>
class MinimalSolverTest : public testing::Test {};
template <typename None, typename... All>
using TypesAfter = testing::Types<All...>;
#define RCME_AND(Solver, name) , Solver
using Solvers = TypesAfter<void RCME_FOR_EACH_SOLVER(RCME_AND)>;
#undef RCME_AND
TYPED_TEST_SUITE(MinimalSolverTest, Solvers);

TYPED_TEST(MinimalSolverTest, ModelsFitTheirSampleAndTheTruthIsAmongThem) {
  using Solver = TypeParam;
  RandomStream rng({.seed = 1, .purpose = 2700});
  int num_near = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const RandomProblem random = MakeProblemFor<Solver>(rng, Solver::kSampleSize);
    const SampleRays<Solver> rays = ComputeSampleRays<Solver>(random.problem);
    const auto C = ConstraintRows(rays.first, rays.second);
    const Vector9d f_true = Vectorize(EssentialFromPose(random.pose_true)) / std::sqrt(2.0);
    double nearest = 2.0;
    for (const auto& model : Solver::FindModels(rays.first, rays.second)) {
      EXPECT_NEAR(model.f.norm(), 1.0, 1e-14);
      EXPECT_LT((C * model.f).norm(), 1e-13);
      EXPECT_LT((model.f.transpose() * model.G).norm(), 1e-12 * model.G.norm());
      nearest = std::min(nearest, Distance(model.f, f_true));
    }
    num_near += nearest < 1e-8;
  }
  EXPECT_GE(num_near, 495);
}

// G by solving again with disturbed constraints: x2 moved so that g_k = n_k at the model, -G n to first
// order.
TYPED_TEST(MinimalSolverTest, GHasANumericTwin) {
  using Solver = TypeParam;
  constexpr int m = Solver::kSampleSize;
  RandomStream rng({.seed = 1, .purpose = 2701});
  int num_compared = 0;
  for (int trial = 0; trial < 40; ++trial) {
    RandomProblem random = MakeProblemFor<Solver>(rng, m);
    if (!std::is_same_v<Solver, OnePoint>) AddNoise(0.5, rng, &random.problem);
    const SampleRays<Solver> rays = ComputeSampleRays<Solver>(random.problem);
    for (const auto& model : Solver::FindModels(rays.first, rays.second)) {
      if (model.G.norm() > 3000.0) continue;  // no digits to compare
      const auto f_of = [&](const Eigen::VectorXd& n) -> Eigen::VectorXd {
        auto moved = rays.second;
        for (int k = 0; k < m; ++k) {
          const auto i = static_cast<size_t>(k);
          const Eigen::Vector3d line = Matricize(model.f) * rays.first[i];
          moved[i].template head<2>() +=
              n(k) / line.template head<2>().squaredNorm() * line.template head<2>();
        }
        Vector9d nearest = -10.0 * model.f;
        for (const auto& other : Solver::FindModels(rays.first, moved)) {
          const Vector9d f = other.f.dot(model.f) < 0.0 ? Vector9d(-other.f) : other.f;
          if ((f - model.f).norm() < (nearest - model.f).norm()) nearest = f;
        }
        return nearest;
      };
      // Small for f and for the rays, which move by n_k over the length of their lines.
      Eigen::VectorXd steps(m);
      for (int k = 0; k < m; ++k) {
        const Eigen::Vector3d line = Matricize(model.f) * rays.first[static_cast<size_t>(k)];
        steps(k) = 1e-3 * std::min(1.0 / model.G.norm(), line.head<2>().norm());
      }
      const Eigen::MatrixXd numeric = NumericJacobian(f_of, Eigen::VectorXd::Zero(m), steps);
      EXPECT_JACOBIAN_NEAR(-model.G, numeric, 1e-4);  // next to double roots f bends most
      ++num_compared;
    }
  }
  EXPECT_GE(num_compared, 10);
}

// 95 % regions of Sigma_p in the limit of small noise, in the dimensions that it has: a car's motion has one.
// False alarm 1e-4; a covariance off by a factor of 1.56 or its inverse is seen.
TYPED_TEST(MinimalSolverTest, TheCovarianceCoversInTheLimitOfSmallNoise) {
  using Solver = TypeParam;
  constexpr int dof = std::min(Solver::kSampleSize, 5);
  RandomStream rng({.seed = 1, .purpose = 2702});
  CoverageCount covered, covered_by_more, covered_by_less;
  for (int trial = 0; trial < 3000; ++trial) {
    RandomProblem random = MakeProblemFor<Solver>(rng, Solver::kSampleSize);
    AddNoise(1e-5, rng, &random.problem);
    const auto hypothesis = NearestHypothesis<Solver>(random);
    double nees = std::numeric_limits<double>::infinity();
    if (hypothesis) {
      const Eigen::SelfAdjointEigenSolver<Matrix5d> eigen(hypothesis->pose_cov);
      const Vector5d error =
          eigen.eigenvectors().transpose() * LocalCoordinates(hypothesis->pose, random.pose_true);
      nees = 0.0;
      for (int i = 5 - dof; i < 5; ++i) nees += error(i) * error(i) / eigen.eigenvalues()(i);
    }
    const double limit = ChiSquareQuantile(dof, 0.95);
    covered.Add(nees <= limit);
    covered_by_more.Add(nees <= 1.5625 * limit);
    covered_by_less.Add(nees <= limit / 1.5625);
  }
  EXPECT_TRUE(covered.Admits(0.95)) << covered;
  EXPECT_FALSE(covered_by_more.Admits(0.95)) << "no power";
  EXPECT_FALSE(covered_by_less.Admits(0.95)) << "no power";
}

// Sigma_p of the textbook propagation, J_p Sigma_f J_p', also where it comes as L L'; its rank; and the point
// tests see no difference between the two.
TYPED_TEST(MinimalSolverTest, TheCovarianceIsThePropagatedOne) {
  using Solver = TypeParam;
  RandomStream rng({.seed = 1, .purpose = 2703});
  for (int trial = 0; trial < 30; ++trial) {
    RandomProblem random = MakeProblemFor<Solver>(rng, Solver::kSampleSize + 1);
    AddNoise(0.1, rng, &random.problem);
    const auto hypothesis = NearestHypothesis<Solver>(random);
    if (!hypothesis) continue;
    const Matrix5d textbook = CovarianceOfMotion(hypothesis->pose, hypothesis->f_cov);
    EXPECT_LT((hypothesis->pose_cov - textbook).norm(), 1e-9 * textbook.norm());
    const Vector5d eigenvalues = Eigen::SelfAdjointEigenSolver<Matrix5d>(hypothesis->pose_cov).eigenvalues();
    EXPECT_GT(eigenvalues(4), 0.0);
    if (Solver::kSampleSize == 1) {
      EXPECT_LT(std::abs(eigenvalues(3)), 1e-14 * eigenvalues(4));
    }
    const MotionProblem& problem = random.problem;
    const auto of_factor = ComputeUncertainFundamental(problem, *hypothesis);
    const auto of_cov =
        UncertainFundamental::From(hypothesis->pose, hypothesis->pose_cov, problem.camera1, problem.camera2);
    ASSERT_TRUE(of_factor && of_cov);
    const Correspondence& fresh = problem.matches.back();
    const double variance = EvaluateResidual(*of_factor, fresh).motion_variance;
    EXPECT_GT(variance, 0.0);
    EXPECT_NEAR(EvaluateResidual(*of_cov, fresh).motion_variance, variance, 1e-6 * variance);
  }
}

TYPED_TEST(MinimalSolverTest, BadNumbersAndRepeatedPointsGiveNoModel) {
  using Solver = TypeParam;
  RandomStream rng({.seed = 1, .purpose = 2704});
  const RandomProblem random = MakeProblemFor<Solver>(rng, Solver::kSampleSize);
  const SampleRays<Solver> good = ComputeSampleRays<Solver>(random.problem);
  EXPECT_GT(Solver::FindModels(good.first, good.second).count, 0);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (size_t k = 0; k < good.first.size(); ++k) {
      SampleRays<Solver> rays = good;
      rays.first[k].x() = bad;
      EXPECT_EQ(Solver::FindModels(rays.first, rays.second).count, 0);
      rays = good;
      rays.second[k].y() = bad;
      EXPECT_EQ(Solver::FindModels(rays.first, rays.second).count, 0);
    }
  }
  if (Solver::kSampleSize == 1) return;
  SampleRays<Solver> twice = good;
  twice.first.back() = twice.first[0];
  twice.second.back() = twice.second[0];
  EXPECT_EQ(Solver::FindModels(twice.first, twice.second).count, 0);
}

TYPED_TEST(MinimalSolverTest, AnIdNamesItsModel) {
  using Solver = TypeParam;
  RandomStream rng({.seed = 1, .purpose = 2705});
  int num_models = 0;
  for (int trial = 0; trial < 20; ++trial) {
    RandomProblem random = MakeProblemFor<Solver>(rng, Solver::kSampleSize);
    AddNoise(0.5, rng, &random.problem);
    const auto all = InstantiateModels<Solver>(random.problem, FirstMatches<Solver>());
    EXPECT_LE(all.count, Solver::kMaxModels);
    for (int k = 0; k < all.count; ++k, ++num_models) {
      const auto& expected = all.models[static_cast<size_t>(k)];
      EXPECT_EQ(expected.id, (HypothesisId{FirstMatches<Solver>(), k}));
      EXPECT_EQ(InstantiateModel<Solver>(random.problem, expected.id).value().model.f, expected.model.f);
    }
    EXPECT_FALSE(InstantiateModel<Solver>(random.problem, {FirstMatches<Solver>(), all.count}));
    EXPECT_FALSE(InstantiateModel<Solver>(random.problem, {FirstMatches<Solver>(), -1}));
  }
  EXPECT_GE(num_models, 20);
}

// Seven equations, five degrees of freedom: chi2_2 in the limit of small noise, of the model nearest to the
// truth. False alarm 1e-4.
TEST(JointSampleStatistic, OfSevenPointsIsChiSquareWithTwoDof) {
  RandomStream rng({.seed = 1, .purpose = 2706});
  CoverageCount within_two, within_three, within_one;
  for (int trial = 0; trial < 4000; ++trial) {
    RandomProblem random = MakeRandomProblem(rng, {.num_matches = 7});
    AddNoise(1e-5, rng, &random.problem);
    const auto hypothesis = NearestHypothesis<SevenPoint>(random);
    const double statistic =
        hypothesis ? JointSampleStatistic(*hypothesis) : std::numeric_limits<double>::infinity();
    within_two.Add(statistic <= ChiSquareQuantile(2, 0.95));
    within_three.Add(statistic <= ChiSquareQuantile(3, 0.95));
    within_one.Add(statistic <= ChiSquareQuantile(1, 0.95));
  }
  EXPECT_TRUE(within_two.Admits(0.95)) << within_two;
  EXPECT_FALSE(within_three.Admits(0.95)) << "no power";
  EXPECT_FALSE(within_one.Admits(0.95)) << "no power";
}

// A car that turns right while it drives ahead: written down, not derived.
TEST(OnePoint, FindsTheYawOfTheCar) {
  RandomStream rng({.seed = 1, .purpose = 2707});
  for (int trial = 0; trial < 200; ++trial) {
    const RandomProblem random = MakeProblemFor<OnePoint>(rng, 1);
    const auto hypothesis = NearestHypothesis<OnePoint>(random);
    ASSERT_TRUE(hypothesis);
    EXPECT_LT(LocalCoordinates(hypothesis->pose, random.pose_true).norm(), 1e-9);
    EXPECT_NEAR(hypothesis->pose.R(1, 1), 1.0, 1e-12) << "not in the plane";
    EXPECT_NEAR(hypothesis->pose.t.y(), 0.0, 1e-12);
  }
}

TEST(OnePoint, APointOfTheHorizonTellsNothing) {
  const OnePoint::Rays first = {Eigen::Vector3d(0.2, 0.0, 1.0)}, second = {Eigen::Vector3d(-0.1, 0.0, 1.0)};
  EXPECT_EQ(OnePoint::FindModels(first, second).count, 0);
}

// The covariance of rank 1 through all that follows: finite entropies, and tests of the point as of any
// other.
TEST(OnePoint, ACovarianceOfRankOneIsAsGoodAsAnyToThePointTests) {
  RandomStream rng({.seed = 1, .purpose = 2708});
  CoverageCount agrees;
  for (int trial = 0; trial < 4000; ++trial) {
    RandomProblem random = MakeProblemFor<OnePoint>(rng, 2);
    AddNoise(0.01, rng, &random.problem);
    const auto hypothesis = NearestHypothesis<OnePoint>(random);
    ASSERT_TRUE(hypothesis);
    const auto model = ComputeUncertainFundamental(random.problem, *hypothesis);
    ASSERT_TRUE(model);
    PointResidual residual, printed;
    const RankAwareTest test(*model, 0.01);
    agrees.Add(test.Distance(random.problem.matches[1], &residual) <= ChiSquareQuantile(1, 0.95));
    EXPECT_GE(test.Entropy(residual), 0.0);
    AsPrintedTest(*model, 0.01).Distance(random.problem.matches[1], &printed);
    EXPECT_TRUE(std::isfinite(printed.log_det_cov));
  }
  EXPECT_TRUE(agrees.Admits(0.95)) << agrees;
}

// The motion of a sample of the exact case fits its sample, so that there is nothing to test.
TEST(FivePoint, ItsMotionsFitTheirSamples) {
  RandomStream rng({.seed = 1, .purpose = 2709});
  for (int trial = 0; trial < 50; ++trial) {
    RandomProblem random = MakeRandomProblem(rng, {.num_matches = 5});
    AddNoise(0.5, rng, &random.problem);
    for (const auto& hypothesis : InstantiateModels<FivePoint>(random.problem, FirstMatches<FivePoint>())) {
      for (const Correspondence& match : random.problem.matches) {
        EXPECT_LT(SquaredSampsonDistance(hypothesis.F, match), 1e-18);
      }
    }
  }
}

}  // namespace
}  // namespace rcme
