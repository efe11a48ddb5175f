#include <numeric>

#include "estimator/geometry/triangulation.h"
#include "estimator/linear_motion.h"
#include "estimator/refinement/reprojection_mle.h"
#include "estimator/refinement/sampson_mle.h"
#include "experiments/audit/claims/calibration.h"
#include "experiments/audit/claims/case.h"
#include "experiments/audit/claims/design.h"
#include "experiments/audit/claims/families.h"
#include "experiments/trial/covariance_score.h"
#include "stats/constants.h"

namespace rcme {
namespace {

using Refine = RefinedMotion (*)(const MotionProblem& problem, const RelativePose& start);

RefinedMotion RefineReprojection(const MotionProblem& problem, const RelativePose& start) {
  std::vector<int> indices(problem.matches.size());
  std::iota(indices.begin(), indices.end(), 0);
  return RefineByReprojection(problem, indices, start, Loss::kSquared);
}

// The optimum over all matches, started at their linear motion; nullopt if there is none.
std::optional<RefinedMotion> FitAll(const MotionProblem& problem, Refine refine) {
  const std::optional<LinearMotion> linear = EstimateLinearMotion(problem);
  if (!linear) return std::nullopt;
  const RelativePose start =
      SelectPoseByCheirality(linear->poses, problem.matches, problem.camera1, problem.camera2);
  const RefinedMotion refined = refine(problem, start);
  return refined.converged ? std::optional(refined) : std::nullopt;
}

// NEES of the optimum with the covariance that it reports.
Statistic NeesStatistic(Refine refine) {
  return [refine](Case& made) -> Outcome {
    const std::optional<RefinedMotion> refined = FitAll(made.problem(), refine);
    if (!refined) return {kInfinity};
    return {NormalizedErrorOfPose(refined->cam2_from_cam1, refined->pose_cov, made.pose_true())};
  };
}

// NEES of the optimum with the Cramer-Rao bound.
Statistic CramerRaoStatistic(Refine refine) {
  return [refine](Case& made) -> Outcome {
    const std::optional<Matrix5d> bound = CramerRaoBound(made);
    const std::optional<RefinedMotion> refined = FitAll(made.problem(), refine);
    if (!refined || !bound) return {kInfinity};
    return {NormalizedErrorOfPose(refined->cam2_from_cam1, *bound, made.pose_true())};
  };
}

CaseClaim MakeClaim(const std::string& id, const std::string& reading, const std::string& sentence,
                    const Statistic& statistic, const TrialLimits& limits) {
  return {{"mle." + id, "Alg. RCME, MLE", reading, sentence, "NEES of the motion, chi2_5", "sigma_px", {}},
          statistic,
          CoverageTargets(5),
          limits,
          {.matches = MatchesOf::kTruth}};
}

}  // namespace

std::vector<CaseClaim> MleCalibration() {
  const std::string reported = "The covariance of maximum likelihood is that of its error";
  return {MakeClaim("reprojection", "reprojection error, motion and points", reported,
                    NeesStatistic(RefineReprojection), kReprojectionCoverage.limits),
          MakeClaim("sampson", "Sampson error, motion alone", reported, NeesStatistic(RefineAllBySampson),
                    kSampleCoverage.limits)};
}

std::vector<Claim> MleClaims() {
  std::vector<CaseClaim> all = MleCalibration();
  all.push_back(MakeClaim("cramer_rao", "Sampson error, motion alone",
                          "Maximum likelihood reaches the Cramer-Rao bound",
                          CramerRaoStatistic(RefineAllBySampson), kSampleCoverage.limits));
  // With a hundred matches: the validity map shows where first order fails with fewer.
  std::vector<Claim> claims;
  for (const CaseClaim& claim : all) {
    claims.push_back(AtNoiseLevels(claim, {0.1, 0.5, 1.0}, {{"num_matches", "100"}}));
  }
  return claims;
}

}  // namespace rcme
