#include <Eigen/Eigenvalues>

#include "estimator/uncertainty/motion_covariance.h"
#include "estimator/uncertainty/svd_differential.h"
#include "experiments/audit/claims/calibration.h"
#include "experiments/audit/claims/design.h"
#include "experiments/audit/claims/families.h"
#include "experiments/audit/claims/sample_statistics.h"
#include "experiments/trial/covariance_score.h"
#include "stats/constants.h"

namespace rcme {
namespace {

const Settings kSample = {{"num_matches", "8"}};

// NEES of the motion with Sigma_p = J_p Sigma_f J_p'. Takes the one of the four motions of the essential
// matrix that is nearest to the truth, because all matches of a pair decide which is right, and no covariance
// describes this choice.
using Jacobian = Eigen::Matrix<double, 5, 9>;
Statistic NeesStatistic(Jacobian (*motion_jacobian)(const EssentialProjection&, const RelativePose&)) {
  return [motion_jacobian](Case& made) -> Outcome {
    const std::optional<Hypothesis<EightPoint>> hypothesis = FitEightPoints(made.problem());
    if (!hypothesis) return {kInfinity};
    const RelativePose pose = NearestPose(PosesFromEssential(hypothesis->projection), made.pose_true());
    const Jacobian J_p = motion_jacobian(hypothesis->projection, pose);
    const Matrix5d pose_cov = J_p * hypothesis->f_cov * J_p.transpose();
    return {NormalizedErrorOfPose(pose, pose_cov, made.pose_true())};
  };
}

Jacobian ThetaJacobian(const EssentialProjection&, const RelativePose& pose) { return MotionJacobian(pose); }

// Whether the 7x7 covariance of p = [q; t] has five eigenvalues above rounding errors, and whether it has
// seven.
Outcome PoseRankStatistic(Case& made) {
  const std::optional<Hypothesis<EightPoint>> hypothesis = FitEightPoints(made.problem());
  if (!hypothesis) return {0.0, 0.0};
  const Eigen::MatrixXd covariance =  // 7 x 7
      CovarianceOfQuaternionAndTranslation(hypothesis->pose, hypothesis->pose_cov);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance);
  const auto rank = (eigen.eigenvalues().array() > 1e-13 * eigen.eigenvalues()(6)).count();
  return {rank == 5 ? 1.0 : 0.0, rank == 7 ? 1.0 : 0.0};
}

}  // namespace

std::vector<CaseClaim> SigmaPCalibration() {
  const auto claim = [](const char* id, const char* reading, const Statistic& nees) -> CaseClaim {
    return {{id,
             "eq::cov_p",
             reading,
             "Sigma_p = J_p Sigma_f J_p' is the covariance of the motion",
             "NEES of the motion, chi2_5",
             "sigma_px",
             {}},
            nees,
            CoverageTargets(5),
            kSampleCoverage.limits,
            {}};
  };
  return {claim("sigma_p.theta", "pseudo-inverse of dTheta/dp", NeesStatistic(ThetaJacobian)),
          claim("sigma_p.svd", "differential of the SVD", NeesStatistic(MotionJacobianBySvd))};
}

std::vector<Claim> SigmaPClaims() {
  const std::vector<CaseClaim> calibration = SigmaPCalibration();
  return {
      AtNoiseLevels(calibration[0], kNoiseLevelsPx, kSample),
      AtNoiseLevels(calibration[1], kNoiseLevelsPx, kSample),
      {"sigma_p.rank",
       "eq::cov_p",
       "7x7, p = (q, t)",
       "The 7x7 covariance of p has full rank",
       "eigenvalues above 1e-13 of the largest",
       "",
       {MakeCheck(kSample, PoseRankStatistic,
                  {PlannedRate("share of rank 7", 1.0, kIdentity, 1), MeasuredRate("share of rank 5")},
                  kIdentity.limits)}},
  };
}

}  // namespace rcme
