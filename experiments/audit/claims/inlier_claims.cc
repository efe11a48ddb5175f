#include "estimator/uncertainty/as_printed.h"
#include "estimator/uncertainty/sampson_covariance.h"
#include "experiments/audit/claims/calibration.h"
#include "experiments/audit/claims/design.h"
#include "experiments/audit/claims/families.h"
#include "experiments/audit/claims/sample_statistics.h"

namespace rcme {
namespace {

// Inverts Sigma_delta by its pseudo-inverse. The whitened derivatives carry the motion's covariance.
double PseudoInverseDistance(const UncertainFundamental& model, double sigma_px,
                             const Correspondence& match) {
  const Eigen::Matrix4d covariance =
      CovarianceOfSampsonVector(model.F, model.dF_whitened, Matrix5d::Identity(), sigma_px, match);
  return RankOneDistance(SampsonVector(model.F, match), covariance);
}

struct PointReading {
  const char *id, *name, *statistic;
  PointDistance distance;
  int degrees_of_freedom;
};

const std::vector<PointReading>& Readings() {
  static const std::vector<PointReading> readings = {
      {"as_printed", "as printed", "delta' Sigma_delta^-1 delta, 4x4 inverse, against chi2_3",
       AsPrintedDistance, 3},
      {"as_printed_chi2_1", "as printed, 1 dof", "delta' Sigma_delta^-1 delta, 4x4 inverse, against chi2_1",
       AsPrintedDistance, 1},
      {"pseudo_inverse", "pseudo-inverse", "delta' Sigma_delta^+ delta against chi2_3", PseudoInverseDistance,
       3},
      {"rank_aware", "rank-aware", "g^2 / (|J|^2 s2) against chi2_1", RankAwareDistance, 1},
  };
  return readings;
}

// The conditions of the true-pose claim on which nothing was tuned: always a million points.
Check UntunedCheck(const PointReading& reading) {
  const Settings settings = {{"num_matches", "1"},
                             {"sigma_px", "0.37"},
                             {"focal_px", "500"},
                             {"image_width", "800"},
                             {"image_height", "600"}};
  return MakeCheck(settings, TruePoseStatistic(reading.distance), CoverageTargets(reading.degrees_of_freedom),
                   kUntunedCoverage.limits);
}

CaseClaim MakeClaim(const std::string& point, const char* label, const PointReading& reading,
                    const char* sentence, const Statistic& statistic, const CaseNeeds& needs) {
  return {{"inlier." + point + "." + reading.id,
           label,
           reading.name,
           sentence,
           reading.statistic,
           "sigma_px",
           {}},
          statistic,
          CoverageTargets(reading.degrees_of_freedom),
          kSampleCoverage.limits,
          needs};
}

CaseClaim TruePoseClaim(const PointReading& reading) {
  return MakeClaim("true_pose", "eq::find-inlier", reading,
                   "Under the true motion 1 - alpha of the points pass the inlier test",
                   TruePoseStatistic(reading.distance), {.num_true_matches = 1});
}

CaseClaim FreshPointClaim(const PointReading& reading) {
  return MakeClaim("fresh_point", "eq::find-inlier", reading,
                   "Of points outside the 8-point sample 1 - alpha pass the inlier test",
                   FreshPointStatistic(reading.distance), {.num_true_matches = 9, .true_motion = false});
}

CaseClaim OwnPointClaim(const PointReading& reading) {
  return MakeClaim("own_point", "eq::sample-p-test", reading,
                   "Of points in the sample 1 - alpha pass the inlier test",
                   OwnPointStatistic(reading.distance), {.num_true_matches = 8, .true_motion = false});
}

}  // namespace

std::vector<CaseClaim> InlierCalibration() {
  std::vector<CaseClaim> claims;
  for (const auto make : {TruePoseClaim, FreshPointClaim, OwnPointClaim}) {
    for (const PointReading& reading : Readings()) claims.push_back(make(reading));
  }
  return claims;
}

std::vector<Claim> InlierClaims() {
  std::vector<Claim> claims;
  for (const PointReading& reading : Readings()) {
    claims.push_back(AtNoiseLevels(TruePoseClaim(reading), {0.01, 0.1, 0.5, 1.0}, {{"num_matches", "1"}}));
    if (reading.distance == RankAwareDistance) claims.back().checks.push_back(UntunedCheck(reading));
  }
  for (const PointReading& reading : Readings()) {
    claims.push_back(AtNoiseLevels(FreshPointClaim(reading), kNoiseLevelsPx, {{"num_matches", "9"}}));
  }
  for (const PointReading& reading : Readings()) {
    claims.push_back(AtNoiseLevels(OwnPointClaim(reading), kNoiseLevelsPx, {{"num_matches", "8"}}));
  }
  return claims;
}

}  // namespace rcme
