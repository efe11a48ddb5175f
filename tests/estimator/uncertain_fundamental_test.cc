#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <limits>

#include "estimator/point_consistency.h"
#include "tests/estimator/uncertain_motion.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

TEST(UncertainFundamental, WhitenedDerivativesCarryTheCovariance) {
  // sum_k dF_k dF_k' (as 9-vectors) = (dF/dp) Sigma_p (dF/dp)': L L' = Sigma_p without looking at L.
  RandomStream rng({.seed = 1, .purpose = 200});
  for (int i = 0; i < 100; ++i) {
    const RandomProblem random = MakeRandomProblem(rng, {.num_matches = 1});
    const Matrix5d pose_cov = RandomPoseCov(0.01, rng);
    const UncertainFundamental model = ComputeUncertainModel(random, pose_cov);
    EXPECT_LT((model.F - ComputeFundamental(random)).norm(), 1e-16);
    const std::array<Eigen::Matrix3d, 5> dF_dp = FundamentalTangent(random);
    Eigen::Matrix<double, 9, 5> tangent, whitened;
    for (int k = 0; k < 5; ++k) {
      tangent.col(k) = Vectorize(dF_dp[static_cast<size_t>(k)]);
      whitened.col(k) = Vectorize(model.dF_whitened[static_cast<size_t>(k)]);
    }
    const Matrix9d expected = tangent * pose_cov * tangent.transpose();
    EXPECT_GT(expected.norm(), 0.0);
    EXPECT_LT((whitened * whitened.transpose() - expected).norm(), 1e-12 * expected.norm());
  }
}

TEST(UncertainFundamental, KnownMotionHasZeroCovariance) {
  RandomStream rng({.seed = 1, .purpose = 201});
  const RandomProblem random = MakeRandomProblem(rng, {.num_matches = 1});
  const auto model = UncertainFundamental::From(random.pose_true, Matrix5d::Zero(), random.problem.camera1,
                                                random.problem.camera2);
  ASSERT_TRUE(model);
  for (const Eigen::Matrix3d& dF : model->dF_whitened) EXPECT_EQ(dF.norm(), 0.0);
}

TEST(UncertainFundamental, SingularCovarianceIsTaken) {
  // A motion known in some directions: positive semi-definite to within rounding, of rank 1 to 4.
  RandomStream rng({.seed = 1, .purpose = 202});
  for (int rank = 1; rank <= 4; ++rank) {
    int num_refused = 0;
    for (int i = 0; i < 100; ++i) {
      const RandomProblem random = MakeRandomProblem(rng, {.num_matches = 1});
      Eigen::MatrixXd root(5, rank);
      for (double& x : root.reshaped()) x = 0.01 * rng.Normal();
      const Matrix5d pose_cov = root * root.transpose();
      const auto model = UncertainFundamental::From(random.pose_true, pose_cov, random.problem.camera1,
                                                    random.problem.camera2);
      if (!model) {
        ++num_refused;
        continue;
      }
      const std::array<Eigen::Matrix3d, 5> dF_dp = FundamentalTangent(random);
      Eigen::Matrix<double, 9, 5> tangent, whitened;
      for (int k = 0; k < 5; ++k) {
        tangent.col(k) = Vectorize(dF_dp[static_cast<size_t>(k)]);
        whitened.col(k) = Vectorize(model->dF_whitened[static_cast<size_t>(k)]);
      }
      const Matrix9d expected = tangent * pose_cov * tangent.transpose();
      EXPECT_LT((whitened * whitened.transpose() - expected).norm(), 1e-10 * expected.norm());
    }
    EXPECT_EQ(num_refused, 0) << "of 100 covariances of rank " << rank;
  }
}

TEST(UncertainFundamental, NoCovarianceNoModel) {
  const RelativePose pose;
  const auto make = [&](const Matrix5d& pose_cov) {
    return UncertainFundamental::From(pose, pose_cov, TestCamera1(), TestCamera2());
  };
  EXPECT_TRUE(make(Matrix5d::Identity()));
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Matrix5d pose_cov = Matrix5d::Identity();
    pose_cov(2, 2) = bad;
    EXPECT_FALSE(make(pose_cov));
    pose_cov = Matrix5d::Identity();
    pose_cov(3, 1) = pose_cov(1, 3) = bad;
    EXPECT_FALSE(make(pose_cov));
  }
  EXPECT_FALSE(make(-Matrix5d::Identity()));
  Matrix5d indefinite = Matrix5d::Identity();
  indefinite(0, 1) = indefinite(1, 0) = 1.5;
  EXPECT_FALSE(make(indefinite));
}

}  // namespace
}  // namespace rcme
