#include <fmt/format.h>

#include <algorithm>

#include "estimator/geometry/essential_matrix.h"
#include "estimator/geometry/sampson.h"
#include "experiments/audit/claims/case.h"
#include "experiments/audit/claims/design.h"
#include "experiments/audit/claims/families.h"
#include "experiments/audit/claims/sample_statistics.h"
#include "stats/constants.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

constexpr const char* kUsac = "opencv_usac";
constexpr double kThresholdSigma = 2.0;  // of the calls below, in standard deviations of a true match

// OpenCV 4.6 weights the residuals of essential and fundamental matrices by a chi-square law with 4 degrees
// of freedom. In MAGSAC++ (Barath et al. 2020) this number is a parameter, the dimension of the residual.
Claim MagsacClaim() {
  const CaseClaim claim = {{"peer.magsac.degrees_of_freedom",
                            "related work",
                            "MAGSAC as OpenCV has it",
                            "The normalised squared residual of a true match has 4 degrees of freedom",
                            "squared Sampson distance of a match from the known motion over sigma^2, chi2_4",
                            "",
                            {}},
                           TruePoseStatistic(RankAwareDistance),
                           CoverageTargets(4),
                           kSampleCoverage.limits,
                           {.num_true_matches = 1}};
  return OnBuiltInScene(claim, {{{"num_matches", "1"}}});
}

// Mean of F(r^2) / F(k^2) over the true matches among the returned inliers, where F is the distribution
// function of chi2_1 and r the residual in units of sigma. It is uniform on 0..1 if r has the law of the
// noise, cut off at the threshold k.
Outcome InSampleStatistic(const MotionEstimator& estimator, const Case& made) {
  RandomStream rng = StreamFor(made.name, StreamPurpose::kSampling);
  const MotionProblem& problem = made.problem();
  const MotionEstimate estimate = estimator.Estimate(problem, rng);
  if (estimate.status != MotionStatus::kOk) return {kNaN};
  const Eigen::Matrix3d F =
      FundamentalFromEssential(EssentialFromPose(estimate.cam2_from_cam1), problem.camera1, problem.camera2);
  const double whole = ChiSquareCdf(1, kThresholdSigma * kThresholdSigma);
  double sum = 0.0;
  int count = 0;
  for (const int index : estimate.inliers) {
    const auto i = static_cast<size_t>(index);
    if (!made.data.truth.is_inlier_true[i]) continue;
    const double r = SampsonVector(F, problem.matches[i]).norm() / problem.sigma_px;
    sum += std::min(1.0, ChiSquareCdf(1, r * r) / whole);
    ++count;
  }
  return {count > 0 ? sum / count : kNaN};
}

std::shared_ptr<const MotionEstimator> Usac() {
  return MakeEstimator(kUsac, {{"threshold_sigma", fmt::format("{}", kThresholdSigma)}});
}

Claim InSampleClaim() {
  const Target target = PlannedBoundedMean("mean of F(r^2) / F(k^2) of its true inliers", 0.5,
                                           Around(0.5, kPeerInliers.margin), {0.0, 1.0}, kPeerInliers);
  std::vector<Check> checks;
  for (const char* num_matches : {"50", "500"}) {
    checks.push_back(MakeCheck(
        {{"num_matches", num_matches}, {"outlier_ratio", "0.2"}},
        [usac = Usac()](Case& made) { return InSampleStatistic(*usac, made); }, {target},
        kPeerInliers.limits));
  }
  return {
      "peer.usac.inlier_residuals",
      "related work",
      "OpenCV's USAC, defaults",
      "Residuals of true inliers under its motion have the law of the noise",
      "PIT of the squared Sampson distance below the threshold of 2 sigma, chi2_1; below 0.5: fitted to them",
      "num_matches",
      checks};
}

Claim RandomMatchesClaim() {
  const Target target =
      ClaimedRate("motions returned for random matches", 0.0, {0.0, kAnswersToNothing.margin});
  const Check check = MakeCheck(
      {{"num_matches", "100"}, {"outlier_ratio", "1"}},
      [usac = Usac()](Case& made) {
        RandomStream rng = StreamFor(made.name, StreamPurpose::kSampling);
        return Outcome{usac->Estimate(made.problem(), rng).status == MotionStatus::kOk ? 1.0 : 0.0};
      },
      {target}, kAnswersToNothing.limits);
  return {"peer.usac.random_matches",
          "related work",
          "OpenCV's USAC, defaults",
          "Matches without any motion are refused (its test of non-randomness cannot be set)",
          "share of trials with all matches random in which a motion is returned",
          "",
          {check}};
}

}  // namespace

std::vector<Claim> PeerClaims(const std::vector<EstimatorEntry>& peers) {
  if (std::ranges::count(peers, kUsac, &EstimatorEntry::name) == 0) return {};
  return {MagsacClaim(), InSampleClaim(), RandomMatchesClaim()};
}

}  // namespace rcme
