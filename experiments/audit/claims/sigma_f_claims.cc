#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include "estimator/solvers/solver_table.h"
#include "estimator/uncertainty/as_printed.h"
#include "experiments/audit/claims/calibration.h"
#include "experiments/audit/claims/design.h"
#include "experiments/audit/claims/families.h"
#include "experiments/audit/claims/sample_statistics.h"
#include "stats/constants.h"

namespace rcme {
namespace {

const Settings kSampleOfF = {{"num_matches", "8"}};
const char* const kSigmaFLabel = "Sec. model_instantiate, Sigma_f";

// Largest deviation of the printed formula from G D G', over the largest entry.
Outcome PrintedFormulaStatistic(Case& made) {
  const MotionProblem& problem = made.problem();
  const std::optional<Hypothesis<EightPoint>> hypothesis = FitEightPoints(problem);
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
    const std::optional<Hypothesis<EightPoint>> hypothesis = FitEightPoints(made.problem());
    if (!hypothesis) return {kInfinity};
    const Vector9d& f = hypothesis->model.f;
    return {(HouseholderColumns(f, onto).transpose() * f).cwiseAbs().maxCoeff()};
  };
}

// Whether the printed J_Omega' Sigma_X^-1 J_Omega (9x9) of five matches has an inverse.
Outcome ExactInverseStatistic(Case& made) {
  const MotionProblem& problem = made.problem();
  const Vector9d f = Vectorize(EssentialFromPose(made.pose_true())).normalized();
  const Matrix9d information =
      SampleInformation(f, problem.camera1, problem.camera2, problem.matches, problem.sigma_px);
  const Eigen::VectorXd eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(Eigen::MatrixXd(information)).eigenvalues();
  return {eigenvalues(0) > 1e-12 * eigenvalues(8) ? 1.0 : 0.0};
}

// Coverage of f by the covariance of a solver's model; one claim per solver.
CaseClaim MakeCoverageClaim(const std::string& name, MinimalSolver solver) {
  const auto [num_matches, is_exact] = VisitSolver(solver, []<typename Solver>(std::type_identity<Solver>) {
    return std::pair(Solver::kSampleSize, Solver::kCase == SolverCase::kExact);
  });
  return {
      {"sigma_f." + name,
       kSigmaFLabel,
       fmt::format("{}, {}-point", is_exact ? "exact" : "overdetermined", num_matches),
       is_exact
           ? "(J_Omega' Sigma_X^-1 J_Omega)^-1 = H^-1 D H^-T, in the coordinates of the solver's models, "
             "is the covariance of f"
           : "Sigma_f = A (A' J_Omega' Sigma_X^-1 J_Omega A)^-1 A' is the covariance of f",
       fmt::format("NEES of f, chi2_{}", num_matches),
       "sigma_px",
       {}},
      [solver](Case& made) -> Outcome { return {NeesOfNearestF(solver, made.problem(), made.pose_true())}; },
      CoverageTargets(num_matches),
      kSampleCoverage.limits,
      {.num_true_matches = num_matches}};
}

// The one-point solver finds only the motion of a car.
Settings MakeSampleSettings(const CaseClaim& claim, MinimalSolver solver) {
  Settings settings = {{"num_matches", fmt::format("{}", claim.needs.num_true_matches)}};
  if (solver == MinimalSolver::kOnePoint) settings.emplace_back("motion", "ackermann");
  return settings;
}

}  // namespace

std::vector<CaseClaim> SigmaFCalibration() {
  std::vector<CaseClaim> claims;
  for (const auto& [name, solver] : SolverNames()) {
    if (solver != MinimalSolver::kOnePoint) claims.push_back(MakeCoverageClaim(name, solver));
  }
  return claims;
}

std::vector<Claim> SigmaFClaims() {
  std::vector<Claim> claims;
  for (const auto& [name, solver] : SolverNames()) {
    const CaseClaim claim = MakeCoverageClaim(name, solver);
    claims.push_back(AtNoiseLevels(claim, kNoiseLevelsPx, MakeSampleSettings(claim, solver)));
  }
  const std::vector<Claim> others = {
      {"sigma_f.formula",
       kSigmaFLabel,
       "overdetermined, 8-point",
       "With dOmega/df the minimum-norm implicit derivative, the printed formula is A (M A)^-1 D (M A)^-T A'",
       "largest relative deviation of an entry, at most 1e-5",
       "",
       {MakeCheck(kSampleOfF, PrintedFormulaStatistic, {IdentityTarget("share within 1e-5", 1e-5)},
                  kIdentity.limits)}},
      {"sigma_f.basis_first_axis",
       kSigmaFLabel,
       "reflection onto the first axis",
       "The first 8 columns of the Householder matrix of f are perpendicular to f (textbook "
       "reflection)",
       "largest |A'f|, at most 1e-12",
       "",
       {MakeCheck(kSampleOfF, NormalBasisStatistic(0), {IdentityTarget("share within 1e-12", 1e-12)},
                  kIdentity.limits)}},
      {"sigma_f.basis_last_axis",
       kSigmaFLabel,
       "reflection onto the last axis",
       "The first 8 columns of the Householder matrix of f are perpendicular to f (f sent to the last axis)",
       "largest |A'f|, at most 1e-12",
       "",
       {MakeCheck(kSampleOfF, NormalBasisStatistic(8), {IdentityTarget("share within 1e-12", 1e-12)},
                  kIdentity.limits)}},
      {"sigma_f.exact_inverse",
       kSigmaFLabel,
       "exact, 5-point, in f as printed",
       "J_Omega' Sigma_X^-1 J_Omega with J_Omega = dOmega/df has an inverse",
       "eigenvalues of the 9x9 matrix above 1e-12 of the largest",
       "",
       {MakeCheck({{"num_matches", "5"}}, ExactInverseStatistic,
                  {PlannedRate("share that has an inverse", 1.0, kIdentity)}, kIdentity.limits)}},
  };
  claims.insert(claims.end(), others.begin(), others.end());
  return claims;
}

}  // namespace rcme
