#include "estimator/uncertainty/motion_covariance.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "estimator/geometry/sampson.h"
#include "estimator/hypothesis.h"
#include "stats/distributions.h"
#include "tests/test_support/coverage_count.h"
#include "tests/test_support/numeric_jacobian.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

constexpr Sample kAllEight = {0, 1, 2, 3, 4, 5, 6, 7};

Hypothesis Solve(const MotionProblem& problem) {
  Hypothesis hypothesis = InstantiateModel(problem, kAllEight).value();
  PropagateCovariance(problem, &hypothesis);
  return hypothesis;
}

RelativePose NearestTo(const RelativePose& reference, const std::array<RelativePose, 4>& poses) {
  const auto distance = [&](const RelativePose& pose) { return LocalCoordinates(reference, pose).norm(); };
  return *std::min_element(poses.begin(), poses.end(), [&](const RelativePose& a, const RelativePose& b) {
    return distance(a) < distance(b);
  });
}

TEST(ConstraintVariances, AreSigmaSquaredTimesTheSquaredGradient) {
  RandomStream rng({.seed = 1, .purpose = 150});
  const RandomProblem random = MakeRandomProblem(rng);
  const Eigen::Matrix3d F = FundamentalFromEssential(EssentialFromPose(random.pose_true),
                                                     random.problem.camera1, random.problem.camera2);
  std::array<Correspondence, 8> sample;
  std::copy_n(random.problem.matches.begin(), 8, sample.begin());
  const Eigen::Matrix<double, 8, 1> variances = ConstraintVariances(F, sample, 0.7);
  for (int k = 0; k < 8; ++k) {
    const Correspondence& match = sample[static_cast<size_t>(k)];
    const auto g = [&](const Eigen::VectorXd& X) {
      const Eigen::Vector3d x1(X(0), X(1), 1.0), x2(X(2), X(3), 1.0);
      return Eigen::VectorXd::Constant(1, x2.dot(F * x1));
    };
    Eigen::Vector4d X;
    X << match.x1_px, match.x2_px;
    EXPECT_NEAR(variances(k), 0.49 * NumericJacobian(g, X, 0.5).squaredNorm(), 1e-9 * variances(k));
    EXPECT_GT(variances(k), 0.0);
  }
}

TEST(CovarianceOfF, EqualsTheTextbookForm) {
  // A (A' J_Omega' Sigma_X^-1 J_Omega A)^-1 A', J_Omega = dOmega/df read sample by sample as the minimum-norm
  // implicit derivative -(dg/dX)^+ (dg/df), 4x9. Its rows and D^-1 share the noise: J_Omega' Sigma_X^-1
  // J_Omega.
  RandomStream rng({.seed = 1, .purpose = 151});
  for (int i = 0; i < 100; ++i) {
    RandomProblem random = MakeRandomProblem(rng);
    AddNoise(0.5, rng, &random.problem);
    const Hypothesis hypothesis = Solve(random.problem);
    const Eigen::Matrix3d F = FundamentalFromEssential(Matricize(hypothesis.linear.f), random.problem.camera1,
                                                       random.problem.camera2);
    Matrix9d information = Matrix9d::Zero();
    double largest_term = 0.0;
    for (const Correspondence& match : random.problem.matches) {
      const Eigen::Vector3d ray1 = random.problem.camera1.Ray(match.x1_px);
      const Eigen::Vector3d ray2 = random.problem.camera2.Ray(match.x2_px);
      const Eigen::RowVector4d dg_dX = EvaluateConstraint(F, match).gradient.transpose();
      const Eigen::Vector4d pseudo_inverse = dg_dX.transpose() / dg_dX.squaredNorm();
      const Eigen::Matrix<double, 4, 9> J_omega =
          -pseudo_inverse * Vectorize(ray2 * ray1.transpose()).transpose();
      information += J_omega.transpose() * J_omega / (random.problem.sigma_px * random.problem.sigma_px);
    }
    largest_term = information.norm();
    const Eigen::Matrix<double, 9, 8>& A = hypothesis.linear.A;
    const Eigen::Matrix<double, 8, 8> reduced = A.transpose() * information * A;
    const Matrix9d textbook = A * reduced.ldlt().solve(A.transpose());
    // The textbook form squares the condition number; ours does not.
    const double condition = largest_term * hypothesis.f_cov.norm();
    EXPECT_LT((hypothesis.f_cov - textbook).norm(), 1e-13 * condition * textbook.norm());
    EXPECT_LT(1e-13 * condition, 0.1) << "no digits to compare";
  }
}

TEST(CovarianceOfF, HasRankEightAndNullVectorF) {
  RandomStream rng({.seed = 1, .purpose = 152});
  RandomProblem random = MakeRandomProblem(rng);
  AddNoise(0.5, rng, &random.problem);
  const Hypothesis hypothesis = Solve(random.problem);
  EXPECT_LT((hypothesis.f_cov * hypothesis.linear.f).norm(), 1e-13 * hypothesis.f_cov.norm());
  EXPECT_LT((hypothesis.f_cov - hypothesis.f_cov.transpose()).norm(), 1e-15 * hypothesis.f_cov.norm());
  const Eigen::Matrix<double, 8, 8> inside =
      hypothesis.linear.A.transpose() * hypothesis.f_cov * hypothesis.linear.A;
  EXPECT_EQ(inside.llt().info(), Eigen::Success);
}

TEST(MotionJacobian, HasANumericTwin) {
  // d(tangent)/df through SVD, projection and the nearest of the four poses, at exact essential matrices;
  // also for -f, whose Jacobian is the negative one.
  RandomStream rng({.seed = 1, .purpose = 153});
  for (int i = 0; i < 50; ++i) {
    const RelativePose pose = RandomPose(rng, 180.0);
    const Vector9d f = Vectorize(EssentialFromPose(pose)) / std::sqrt(2.0);
    const auto motion = [&](const Eigen::VectorXd& moved) -> Eigen::VectorXd {
      const auto poses = PosesFromEssential(ProjectToEssential(Matricize(moved)));
      return LocalCoordinates(pose, NearestTo(pose, poses));
    };
    EXPECT_JACOBIAN_NEAR(MotionJacobian(pose), NumericJacobian(motion, f, 1e-3), 1e-7);
    EXPECT_JACOBIAN_NEAR(-MotionJacobian(pose), NumericJacobian(motion, -f, 1e-3), 1e-7);
  }
}

TEST(MotionJacobian, InvertsTheUnitTangent) {
  RandomStream rng({.seed = 1, .purpose = 154});
  for (int i = 0; i < 20; ++i) {
    const RelativePose pose = RandomPose(rng, 180.0);
    const std::array<Eigen::Matrix3d, 5> dE_dp = EssentialTangent(pose);
    Eigen::Matrix<double, 9, 5> tangent;
    for (int k = 0; k < 5; ++k) tangent.col(k) = Vectorize(dE_dp[static_cast<size_t>(k)]) / std::sqrt(2.0);
    EXPECT_LT((MotionJacobian(pose) * tangent - Matrix5d::Identity()).norm(), 1e-13);
  }
}

TEST(CovarianceOfMotion, IsTheSameForAllFourPosesUpToTheirTangents) {
  // dg/dp Sigma_p dg/dp' of a match, which is all that the loop uses, must not depend on cheirality.
  RandomStream rng({.seed = 1, .purpose = 155});
  for (int i = 0; i < 20; ++i) {
    RandomProblem random = MakeRandomProblem(rng);
    AddNoise(0.5, rng, &random.problem);
    const Hypothesis hypothesis = Solve(random.problem);
    const Eigen::Vector3d ray1(0.2, -0.1, 1.0), ray2(-0.15, 0.22, 1.0);
    std::vector<double> variances;
    for (const RelativePose& pose : PosesFromEssential(hypothesis.projection)) {
      const std::array<Eigen::Matrix3d, 5> dE_dp = EssentialTangent(pose);
      Vector5d g_p;
      for (int k = 0; k < 5; ++k) g_p(k) = ray2.dot(dE_dp[static_cast<size_t>(k)] * ray1);
      variances.push_back(g_p.dot(CovarianceOfMotion(pose, hypothesis.f_cov) * g_p));
    }
    for (const double variance : variances) EXPECT_NEAR(variance, variances[0], 1e-9 * variances[0]);
    EXPECT_GT(variances[0], 0.0);
  }
}

TEST(CovarianceOfQuaternionAndTranslation, HasRankFive) {
  RandomStream rng({.seed = 1, .purpose = 156});
  for (int i = 0; i < 20; ++i) {
    const RelativePose pose = RandomPose(rng, 180.0);
    Matrix5d root;
    for (double& x : root.reshaped()) x = rng.Normal();
    const Matrix5d pose_cov = root * root.transpose() + Matrix5d::Identity();
    const Eigen::Matrix<double, 7, 7> cov = CovarianceOfQuaternionAndTranslation(pose, pose_cov);
    const Eigen::VectorXd eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 7, 7>>(cov).eigenvalues();
    EXPECT_LT(std::abs(eigenvalues(1)), 1e-14 * eigenvalues(6));
    EXPECT_GT(eigenvalues(2), 1e-4 * eigenvalues(6));
    // The null directions are q and t themselves, whose lengths are fixed.
    const Eigen::Matrix<double, 7, 1> p = QuaternionAndTranslation(pose);
    Eigen::Matrix<double, 7, 2> lengths = Eigen::Matrix<double, 7, 2>::Zero();
    lengths.block<4, 1>(0, 0) = p.head<4>();
    lengths.block<3, 1>(4, 1) = p.tail<3>();
    EXPECT_LT((cov * lengths).norm(), 1e-14 * cov.norm());
  }
}

// NEES of Sigma_p (5 dof) and of Sigma_f (8 dof, on the basis A) over random motions and random minimal
// samples.
struct NormalizedErrors {
  std::vector<double> pose, f;
};

NormalizedErrors MeasureErrors(double sigma_px, int num_trials, std::uint32_t purpose) {
  NormalizedErrors errors;
  RandomStream rng({.seed = 1, .purpose = purpose});
  for (int trial = 0; trial < num_trials; ++trial) {
    RandomProblem random = MakeRandomProblem(rng);
    AddNoise(sigma_px, rng, &random.problem);
    const Hypothesis hypothesis = Solve(random.problem);
    // The estimate's own tangent, as a user of the covariance would have it.
    const RelativePose estimate = NearestTo(random.pose_true, PosesFromEssential(hypothesis.projection));
    const Matrix5d pose_cov = CovarianceOfMotion(estimate, hypothesis.f_cov);
    const Vector5d pose_error = LocalCoordinates(estimate, random.pose_true);
    errors.pose.push_back(pose_error.dot(pose_cov.llt().solve(pose_error)));

    Vector9d f_true = Vectorize(EssentialFromPose(random.pose_true)) / std::sqrt(2.0);
    if (f_true.dot(hypothesis.linear.f) < 0.0) f_true = -f_true;
    const Eigen::Matrix<double, 9, 8>& A = hypothesis.linear.A;
    const Eigen::Matrix<double, 8, 1> f_error = A.transpose() * f_true;
    const Eigen::Matrix<double, 8, 8> f_cov = A.transpose() * hypothesis.f_cov * A;
    errors.f.push_back(f_error.dot(f_cov.llt().solve(f_error)));
  }
  return errors;
}

// How often the 95 % region of the covariance times `scale` holds the truth.
CoverageCount Coverage(const std::vector<double>& normalized_errors, int dof, double scale) {
  const double limit = ChiSquareQuantile(dof, 0.95);
  CoverageCount count;
  for (const double error : normalized_errors) count.Add(error / scale <= limit);
  return count;
}

TEST(MotionCovariance, CoversInTheLimitOfSmallNoise) {
  // Random minimal samples differ a thousandfold in conditioning, and the first order holds for each only
  // well below its own noise level: over 20 000 samples of this family the 95 % region of Sigma_p (Sigma_f)
  // covered 0.632 (0.787) at 0.5 px, 0.801 (0.906) at 0.1, 0.902 (0.946) at 0.01, 0.935 (0.950) at 0.001,
  // 0.947 (0.950) at 1e-4, 0.950 (0.950) at 1e-5. So 1e-5 it is. False alarm 2e-4; a covariance off by a
  // factor of 1.25 covers 0.983, of 0.8 covers 0.885, and the interval is 0.012 wide: power 1.
  const NormalizedErrors errors = MeasureErrors(1e-5, 20'000, 160);
  const CoverageCount pose = Coverage(errors.pose, 5, 1.0), f = Coverage(errors.f, 8, 1.0);
  EXPECT_TRUE(pose.Admits(0.95)) << "Sigma_p: " << pose;
  EXPECT_TRUE(f.Admits(0.95)) << "Sigma_f: " << f;
  for (const double scale : {1.25, 0.8}) {
    EXPECT_FALSE(Coverage(errors.pose, 5, scale).Admits(0.95)) << "no power against Sigma_p times " << scale;
    EXPECT_FALSE(Coverage(errors.f, 8, scale).Admits(0.95)) << "no power against Sigma_f times " << scale;
  }
}

}  // namespace
}  // namespace rcme
