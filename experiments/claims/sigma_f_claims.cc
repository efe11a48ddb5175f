#include "estimator/uncertainty/as_printed.h"
#include "experiments/claims/families.h"
#include "experiments/claims/limits.h"
#include "experiments/claims/sample_statistics.h"

namespace rcme {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Settings kSample = {{"num_matches", "8"}};

Outcome NeesStatistic(Case& made) {
  const std::optional<Hypothesis> hypothesis = FitSample(made.problem());
  return {hypothesis ? NeesOfF(*hypothesis, made.pose_true()) : kInfinity};
}

// Largest deviation of the printed formula from G D G', over the largest entry.
Outcome PrintedFormulaStatistic(Case& made) {
  const MotionProblem& problem = made.problem();
  const std::optional<Hypothesis> hypothesis = FitSample(problem);
  if (!hypothesis) return {kInfinity};
  const LinearModel& linear = hypothesis->linear;
  const Matrix9d information =
      SampleInformation(linear.f, problem.camera1, problem.camera2, problem.matches, problem.sigma_px);
  const Matrix9d printed = OverdeterminedCovariance(information, HouseholderColumns(linear.f, 8));
  return {(printed - hypothesis->f_cov).cwiseAbs().maxCoeff() / hypothesis->f_cov.cwiseAbs().maxCoeff()};
}

// Largest |A'f| of the first eight columns of the Householder matrix that reflects f onto an axis.
Statistic NormalBasisStatistic(int onto) {
  return [onto](Case& made) -> Outcome {
    const std::optional<Hypothesis> hypothesis = FitSample(made.problem());
    if (!hypothesis) return {kInfinity};
    const Vector9d& f = hypothesis->linear.f;
    return {(HouseholderColumns(f, onto).transpose() * f).cwiseAbs().maxCoeff()};
  };
}

}  // namespace

std::vector<Claim> SigmaFClaims() {
  const char* kLabel = "Sec. model_instantiate, Sigma_f";
  return {
      {"sigma_f.coverage", kLabel, "overdetermined, 8-point",
       "Sigma_f = A (A' J_Omega' Sigma_X^-1 J_Omega A)^-1 A' is the covariance of f",
       "NEES of f in the complement of f, chi2_8", "sigma_px",
       SigmaLadder(kNoiseLadderPx, kSample, NeesStatistic, CoverageTargets(8), kMicroseconds)},
      {"sigma_f.formula",
       kLabel,
       "overdetermined, 8-point",
       "With dOmega/df the minimum-norm implicit derivative, the printed formula is A (M A)^-1 D (M A)^-T A'",
       "largest relative deviation of an entry, at most 1e-5",
       "",
       {MakeCheck(kSample, PrintedFormulaStatistic, {IdentityTarget("share within 1e-5", 1e-5)},
                  kMicroseconds)}},
      {"sigma_f.basis_first_axis",
       kLabel,
       "reflection onto the first axis",
       "The first 8 columns of the Householder matrix of f are perpendicular to f (the textbook reflection)",
       "largest |A'f|, at most 1e-12",
       "",
       {MakeCheck(kSample, NormalBasisStatistic(0), {IdentityTarget("share within 1e-12", 1e-12)},
                  kMicroseconds)}},
      {"sigma_f.basis_last_axis",
       kLabel,
       "reflection onto the last axis",
       "The first 8 columns of the Householder matrix of f are perpendicular to f (f sent to the last axis)",
       "largest |A'f|, at most 1e-12",
       "",
       {MakeCheck(kSample, NormalBasisStatistic(8), {IdentityTarget("share within 1e-12", 1e-12)},
                  kMicroseconds)}},
  };
}

}  // namespace rcme
