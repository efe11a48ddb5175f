#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "estimator/uncertainty/sampson_covariance.h"
#include "experiments/audit/claims/design.h"
#include "experiments/audit/claims/families.h"
#include "experiments/audit/claims/sample_statistics.h"
#include "stats/constants.h"

namespace rcme {
namespace {

// The motion of the first eight matches, moved to the truth, with its covariance; and a match that fits this
// motion exactly.
struct ExactFit {
  UncertainFundamental model;
  Correspondence match;
  Eigen::Vector4d normal;  // unit gradient of the constraint there
};

std::optional<ExactFit> MakeExactFit(const Case& made) {
  const MotionProblem& problem = made.problem();
  const std::optional<Hypothesis<EightPoint>> hypothesis = FitEightPoints(problem);
  if (!hypothesis) return std::nullopt;
  const std::optional<UncertainFundamental> model =
      UncertainFundamental::From(made.pose_true(), hypothesis->pose_cov, problem.camera1, problem.camera2);
  if (!model) return std::nullopt;
  const Eigen::Vector3d& point = made.scene.points_in_cam1.front();
  const Correspondence match{problem.camera1.Project(point),
                             problem.camera2.Project(made.scene.InCamera2(point))};
  return ExactFit{*model, match, EvaluateConstraint(model->F, match).gradient.normalized()};
}

// The match at a distance (px) from the motion along the normal.
Correspondence MovedOff(const ExactFit& fit, double distance_px) {
  Correspondence match = fit.match;
  match.x1_px += distance_px * fit.normal.head<2>();
  match.x2_px += distance_px * fit.normal.tail<2>();
  return match;
}

// Whether the 4x4 covariance at g = 0 can be inverted, and whether its rank is one.
Outcome SampsonRankStatistic(Case& made) {
  const std::optional<ExactFit> fit = MakeExactFit(made);
  if (!fit) return {0.0, 0.0};
  const Eigen::Matrix4d covariance = CovarianceOfSampsonVector(
      fit->model.F, fit->model.dF_whitened, Matrix5d::Identity(), made.problem().sigma_px, fit->match);
  const Eigen::Vector4d variances = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(covariance).eigenvalues();
  return {variances(0) > 1e-12 * variances(3) ? 1.0 : 0.0, variances(2) < 1e-12 * variances(3) ? 1.0 : 0.0};
}

// log det Sigma_delta = log det(B B'), B = [sigma J_X, J_p L] (4x9). It does not use a closed form, which
// would already know the dependence on g. It uses B instead of the 4x4 matrix, whose three small eigenvalues
// fall as g^2 below its rounding errors.
double LogDeterminant(const ExactFit& fit, double sigma_px, const Correspondence& match) {
  Eigen::MatrixXd factor(9, 4);  // B'
  factor.topRows<4>() = sigma_px * SampsonVectorPointJacobian(fit.model.F, match).transpose();
  factor.bottomRows<5>() = SampsonVectorPoseJacobian(fit.model.F, fit.model.dF_whitened, match).transpose();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(factor);
  return 2.0 * qr.matrixQR().diagonal().array().abs().log().sum();
}

// Deviation of the exponent of det Sigma_delta in g from 6, between 0.01 and 0.003 px from the motion.
Outcome DeterminantStatistic(Case& made) {
  constexpr double kFarPx = 0.01, kNearPx = 0.003;
  const std::optional<ExactFit> fit = MakeExactFit(made);
  if (!fit) return {kInfinity};
  const double sigma_px = made.problem().sigma_px;
  const double far = LogDeterminant(*fit, sigma_px, MovedOff(*fit, kFarPx));
  const double near = LogDeterminant(*fit, sigma_px, MovedOff(*fit, kNearPx));
  return {std::abs((far - near) / std::log(kFarPx / kNearPx) - 6.0)};
}

// Squared length of the Sampson vector of a match under the true motion, in units of sigma^2.
Outcome SquaredLengthStatistic(Case& made) {
  const MotionProblem& problem = made.problem();
  const Eigen::Matrix3d F =
      FundamentalFromEssential(EssentialFromPose(made.pose_true()), problem.camera1, problem.camera2);
  const Eigen::Vector4d delta = SampsonVector(F, problem.matches.front());
  return {delta.squaredNorm() / (problem.sigma_px * problem.sigma_px)};
}

}  // namespace

std::vector<Claim> SampsonClaims() {
  const std::vector<double> sigmas_px = {0.01, 0.1, 0.5, 1.0};
  return {
      {"sampson.full_rank",
       "eq::cov_sampson_error_vec",
       "as printed",
       "Sigma_delta of an exact point has an inverse",
       "eigenvalues above 1e-12 of the largest",
       "",
       {MakeCheck({{"num_matches", "8"}}, SampsonRankStatistic,
                  {PlannedRate("share of rank 4", 1.0, kIdentity, 0), MeasuredRate("share of rank 1", 1)},
                  kIdentity.limits)}},
      {"sampson.determinant",
       "eq::score-inliers",
       "as printed",
       "det Sigma_delta falls as g^6 towards g = 0: the printed entropy holds 3 log|g|",
       "deviation from 6 of the exponent in g of the determinant of J Sigma J', at most 0.1",
       "",
       {MakeCheck({{"num_matches", "8"}}, DeterminantStatistic, {IdentityTarget("share within 0.1", 0.1)},
                  kIdentity.limits)}},
      {"sampson.dof_3", "Sec. p_comp_tests", "as printed, 3 dof",
       "The Sampson vector has 4 - 1 = 3 degrees of freedom",
       "|delta|^2 / sigma^2 under the true motion, chi2_3", "sigma_px",
       ChecksAtNoiseLevels(sigmas_px, {{"num_matches", "1"}}, SquaredLengthStatistic, CoverageTargets(3),
                           kSampleCoverage.limits)},
      {"sampson.dof_1", "Sec. p_comp_tests", "rank-aware, 1 dof",
       "The Sampson vector has 1 degree of freedom", "|delta|^2 / sigma^2 under the true motion, chi2_1",
       "sigma_px",
       ChecksAtNoiseLevels(sigmas_px, {{"num_matches", "1"}}, SquaredLengthStatistic, CoverageTargets(1),
                           kSampleCoverage.limits)},
  };
}

}  // namespace rcme
