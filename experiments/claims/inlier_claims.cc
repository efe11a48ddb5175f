#include "estimator/uncertainty/as_printed.h"
#include "estimator/uncertainty/sampson_covariance.h"
#include "experiments/claims/families.h"
#include "experiments/claims/limits.h"
#include "experiments/claims/sample_statistics.h"

namespace rcme {
namespace {

// Sigma_delta by its pseudo-inverse; the whitened derivatives carry the motion's covariance.
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

// The conditions of the true-pose claim that nothing was chosen on: always a million points.
Check UntunedCheck(const PointReading& reading) {
  const Settings settings = {{"num_matches", "1"},
                             {"sigma_px", "0.37"},
                             {"focal_px", "500"},
                             {"image_width", "800"},
                             {"image_height", "600"}};
  return MakeCheck(settings, TruePoseStatistic(reading.distance), CoverageTargets(reading.degrees_of_freedom),
                   {1'000'000, 1'000'000, 1'000'000});
}

Claim TruePoseClaim(const PointReading& reading) {
  Claim claim{std::string("inlier.true_pose.") + reading.id,
              "eq::find-inlier",
              reading.name,
              "Of the points seen by a motion that is known exactly, 1 - alpha pass the inlier test",
              reading.statistic,
              "sigma_px",
              SigmaLadder({0.01, 0.1, 0.5, 1.0}, {{"num_matches", "1"}}, TruePoseStatistic(reading.distance),
                          CoverageTargets(reading.degrees_of_freedom), kMicroseconds)};
  if (reading.distance == RankAwareDistance) claim.checks.push_back(UntunedCheck(reading));
  return claim;
}

Claim FreshPointClaim(const PointReading& reading) {
  return {std::string("inlier.fresh_point.") + reading.id,
          "eq::find-inlier",
          reading.name,
          "Of the points that did not take part in the 8-point motion, 1 - alpha pass the inlier test",
          reading.statistic,
          "sigma_px",
          SigmaLadder(kNoiseLadderPx, {{"num_matches", "9"}}, FreshPointStatistic(reading.distance),
                      CoverageTargets(reading.degrees_of_freedom), kMicroseconds)};
}

Claim OwnPointClaim(const PointReading& reading) {
  return {std::string("inlier.own_point.") + reading.id,
          "eq::sample-p-test",
          reading.name,
          "Of the points of the sample that made the motion, 1 - alpha pass the same test",
          reading.statistic,
          "sigma_px",
          SigmaLadder(kNoiseLadderPx, {{"num_matches", "8"}}, OwnPointStatistic(reading.distance),
                      CoverageTargets(reading.degrees_of_freedom), kMicroseconds)};
}

}  // namespace

std::vector<Claim> InlierClaims() {
  std::vector<Claim> claims;
  for (const auto make : {TruePoseClaim, FreshPointClaim, OwnPointClaim}) {
    for (const PointReading& reading : Readings()) claims.push_back(make(reading));
  }
  return claims;
}

}  // namespace rcme
