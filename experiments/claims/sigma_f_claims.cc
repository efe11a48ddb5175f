#include <Eigen/Eigenvalues>

#include "estimator/solvers/five_point.h"
#include "estimator/uncertainty/as_printed.h"
#include "experiments/claims/calibration.h"
#include "experiments/claims/design.h"
#include "experiments/claims/families.h"
#include "experiments/claims/sample_statistics.h"
#include "experiments/trial/covariance_score.h"

namespace rcme {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Settings kSample = {{"num_matches", "8"}};
const char* const kLabel = "Sec. model_instantiate, Sigma_f";

Outcome NeesStatistic(Case& made) {
  const std::optional<Hypothesis<EightPoint>> hypothesis = FitSample(made.problem());
  return {hypothesis ? NeesOfF(*hypothesis, made.pose_true()) : kInfinity};
}

// Largest deviation of the printed formula from G D G', over the largest entry.
Outcome PrintedFormulaStatistic(Case& made) {
  const MotionProblem& problem = made.problem();
  const std::optional<Hypothesis<EightPoint>> hypothesis = FitSample(problem);
  if (!hypothesis) return {kInfinity};
  const LinearModel& linear = hypothesis->model;
  const Matrix9d information =
      SampleInformation(linear.f, problem.camera1, problem.camera2, problem.matches, problem.sigma_px);
  const Matrix9d printed = OverdeterminedCovariance(information, HouseholderColumns(linear.f, 8));
  return {(printed - hypothesis->f_cov).cwiseAbs().maxCoeff() / hypothesis->f_cov.cwiseAbs().maxCoeff()};
}

// Largest |A'f| of the first eight columns of the Householder matrix that reflects f onto an axis.
Statistic NormalBasisStatistic(int onto) {
  return [onto](Case& made) -> Outcome {
    const std::optional<Hypothesis<EightPoint>> hypothesis = FitSample(made.problem());
    if (!hypothesis) return {kInfinity};
    const Vector9d& f = hypothesis->model.f;
    return {(HouseholderColumns(f, onto).transpose() * f).cwiseAbs().maxCoeff()};
  };
}

// NEES of the exact case with H^-1 D H^-T, for the five-point solution nearest to the truth.
Outcome ExactNeesStatistic(Case& made) {
  const MotionProblem& problem = made.problem();
  double nearest = kInfinity;  // squared length of the error
  Outcome nees = {kInfinity};
  for (Hypothesis<FivePoint> hypothesis : InstantiateModels<FivePoint>(problem, {0, 1, 2, 3, 4})) {
    hypothesis.pose = NearestPose(PosesFromEssential(hypothesis.projection), made.pose_true());
    const double squared_error = LocalCoordinates(hypothesis.pose, made.pose_true()).squaredNorm();
    if (squared_error >= nearest) continue;
    nearest = squared_error;
    PropagateCovariance(problem, &hypothesis);
    nees[0] = NormalizedErrorOfPose(hypothesis.pose, hypothesis.pose_cov, made.pose_true());
  }
  return nees;
}

// Whether the printed J_Omega' Sigma_X^-1 J_Omega (9x9) of five matches has an inverse.
Outcome ExactInverseStatistic(Case& made) {
  const MotionProblem& problem = made.problem();
  const Vector9d f = Vectorize(EssentialFromPose(made.pose_true())).normalized();
  const Matrix9d information =
      SampleInformation(f, problem.camera1, problem.camera2, problem.matches, problem.sigma_px);
  const Vector9d eigenvalues = Eigen::SelfAdjointEigenSolver<Matrix9d>(information).eigenvalues();
  return {eigenvalues(0) > 1e-12 * eigenvalues(8) ? 1.0 : 0.0};
}

}  // namespace

std::vector<CaseClaim> SigmaFCalibration() {
  return {{{"sigma_f.coverage",
            kLabel,
            "overdetermined, 8-point",
            "Sigma_f = A (A' J_Omega' Sigma_X^-1 J_Omega A)^-1 A' is the covariance of f",
            "NEES of f in the complement of f, chi2_8",
            "sigma_px",
            {}},
           NeesStatistic,
           CoverageTargets(8),
           kSampleCoverage.limits,
           {}},
          {{"sigma_f.exact",
            kLabel,
            "exact, 5-point, in the motion's five coordinates",
            "(J_Omega' Sigma_X^-1 J_Omega)^-1 = H^-1 D H^-T is the covariance of the exact case",
            "NEES of the motion, chi2_5",
            "sigma_px",
            {}},
           ExactNeesStatistic,
           CoverageTargets(5),
           kSampleCoverage.limits,
           {.num_true_matches = 5}}};
}

std::vector<Claim> SigmaFClaims() {
  const std::vector<CaseClaim> calibration = SigmaFCalibration();
  return {
      AtNoiseLevels(calibration[0], kNoiseLevelsPx, kSample),
      {"sigma_f.formula",
       kLabel,
       "overdetermined, 8-point",
       "With dOmega/df the minimum-norm implicit derivative, the printed formula is A (M A)^-1 D (M A)^-T A'",
       "largest relative deviation of an entry, at most 1e-5",
       "",
       {MakeCheck(kSample, PrintedFormulaStatistic, {IdentityTarget("share within 1e-5", 1e-5)},
                  kIdentity.limits)}},
      {"sigma_f.basis_first_axis",
       kLabel,
       "reflection onto the first axis",
       "The first 8 columns of the Householder matrix of f are perpendicular to f (the textbook reflection)",
       "largest |A'f|, at most 1e-12",
       "",
       {MakeCheck(kSample, NormalBasisStatistic(0), {IdentityTarget("share within 1e-12", 1e-12)},
                  kIdentity.limits)}},
      {"sigma_f.basis_last_axis",
       kLabel,
       "reflection onto the last axis",
       "The first 8 columns of the Householder matrix of f are perpendicular to f (f sent to the last axis)",
       "largest |A'f|, at most 1e-12",
       "",
       {MakeCheck(kSample, NormalBasisStatistic(8), {IdentityTarget("share within 1e-12", 1e-12)},
                  kIdentity.limits)}},
      AtNoiseLevels(calibration[1], kNoiseLevelsPx, {{"num_matches", "5"}}),
      {"sigma_f.exact_inverse",
       kLabel,
       "exact, 5-point, in f as printed",
       "J_Omega' Sigma_X^-1 J_Omega of the exact case, with J_Omega = dOmega/df, has an inverse",
       "eigenvalues of the 9x9 matrix above 1e-12 of the largest",
       "",
       {MakeCheck({{"num_matches", "5"}}, ExactInverseStatistic,
                  {PlannedRate("share that has an inverse", 1.0, kIdentity)}, kIdentity.limits)}},
  };
}

}  // namespace rcme
