#include "estimator/uncertainty/as_printed.h"

#include <gtest/gtest.h>

#include "estimator/hypothesis.h"
#include "estimator/solvers/eight_point.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

// The first `count` random problems' hypotheses of their eight matches.
std::vector<std::pair<MotionProblem, Hypothesis<EightPoint>>> RandomHypotheses(std::uint32_t count) {
  std::vector<std::pair<MotionProblem, Hypothesis<EightPoint>>> hypotheses;
  for (std::uint32_t trial = 0; hypotheses.size() < count; ++trial) {
    RandomStream rng({1, 0, trial, 90});
    RandomProblem random = MakeRandomProblem(rng);
    AddNoise(0.1, rng, &random.problem);
    std::optional<Hypothesis<EightPoint>> hypothesis =
        InstantiateModel<EightPoint>(random.problem, {{0, 1, 2, 3, 4, 5, 6, 7}});
    if (!hypothesis) continue;
    PropagateCovariance(random.problem, &*hypothesis);
    hypotheses.emplace_back(random.problem, *hypothesis);
  }
  return hypotheses;
}

TEST(OverdeterminedCovariance, IsTheCovarianceByTheGainOfTheSolver) {
  for (const auto& [problem, hypothesis] : RandomHypotheses(50)) {
    const Matrix9d information = SampleInformation(hypothesis.model.f, problem.camera1, problem.camera2,
                                                   problem.matches, problem.sigma_px);
    const Matrix9d printed = OverdeterminedCovariance(information, HouseholderColumns(hypothesis.model.f, 8));
    const double scale = hypothesis.f_cov.cwiseAbs().maxCoeff();
    ASSERT_GT(scale, 0.0);
    EXPECT_LT((printed - hypothesis.f_cov).cwiseAbs().maxCoeff(), 1e-5 * scale);
  }
}

TEST(HouseholderColumns, AreOrthonormalAndNormalToFOnlyForTheLastAxis) {
  for (const auto& [problem, hypothesis] : RandomHypotheses(20)) {
    const Vector9d& f = hypothesis.model.f;
    for (const int onto : {0, 4, 8}) {
      const Eigen::Matrix<double, 9, 8> A = HouseholderColumns(f, onto);
      EXPECT_LT((A.transpose() * A - Eigen::Matrix<double, 8, 8>::Identity()).cwiseAbs().maxCoeff(), 1e-14);
      const double along_f = (A.transpose() * f).cwiseAbs().maxCoeff();
      EXPECT_NEAR(along_f, onto == 8 ? 0.0 : 1.0, 1e-14);
    }
  }
}

TEST(RankOneDistance, KnownAnswer) {
  // Sigma = 4 u u' + tiny, delta = 3 u: 9 / 4.
  const Eigen::Vector4d u = Eigen::Vector4d(1.0, -2.0, 0.5, 3.0).normalized();
  const Eigen::Matrix4d covariance = 4.0 * u * u.transpose() + 1e-12 * Eigen::Matrix4d::Identity();
  EXPECT_NEAR(RankOneDistance(3.0 * u, covariance), 2.25, 1e-9);
  EXPECT_NEAR(RankOneDistance(-3.0 * u, covariance), 2.25, 1e-9);
}

}  // namespace
}  // namespace rcme
