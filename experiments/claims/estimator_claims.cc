#include "experiments/claims/call_estimator.h"
#include "experiments/claims/families.h"
#include "experiments/claims/limits.h"

namespace rcme {

std::vector<Claim> EstimatorClaims(const std::vector<EstimatorEntry>& estimators) {
  std::vector<Target> targets = CoverageTargets(5);
  targets.push_back(MeasuredRate("returns a motion", 1));
  targets.push_back(MeasuredRate("fails", 2));
  std::vector<Claim> claims;
  for (const EstimatorEntry& entry : estimators) {
    std::shared_ptr<const MotionEstimator> estimator = entry.make(RansacOptions());
    Claim claim{"estimator.coverage." + entry.name,
                "Sec. model selection, MLE",
                entry.name + ", defaults",
                "The covariance that comes with a returned motion is that of its error",
                "NEES of the returned motion, chi2_5",
                "outlier_ratio",
                {}};
    for (const char* outlier_ratio : {"0", "0.2"}) {
      claim.checks.push_back(
          MakeCheck({{"num_matches", "100"}, {"outlier_ratio", outlier_ratio}},
                    [estimator](Case& made) { return ReportedCovarianceStatistic(*estimator, made); },
                    targets, {800, 800, 60'000}));
    }
    claims.push_back(std::move(claim));
  }
  return claims;
}

}  // namespace rcme
