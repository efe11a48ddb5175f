#include "experiments/audit/claims/call_estimator.h"
#include "experiments/audit/claims/design.h"
#include "experiments/audit/claims/families.h"
#include "stats/constants.h"

namespace rcme {
namespace {

// For an answer, valid or not: whether it is flagged, if it failed; whether it is not flagged, if it did not;
// whether it failed.
Outcome FlagStatistic(const MotionEstimator& estimator, const Case& made) {
  const TrialRecord record = CallEstimator(estimator, made);
  if (HasRefused(record)) return {kNaN, kNaN, kNaN};
  const bool has_failed = FailsSilently(record);
  return {has_failed ? 1.0 * record.failed_by_kappa : kNaN, has_failed ? kNaN : 1.0 * !record.failed_by_kappa,
          1.0 * has_failed};
}

}  // namespace

std::vector<Claim> FlagClaims() {
  const std::vector<Target> targets = {
      PlannedRate("sensitivity: failures that are flagged", 1.0, kFlagDesign, 0),
      PlannedRate("specificity: good motions that are not", 1.0, kFlagDesign, 1),
      MeasuredRate("failures of the estimator", 2)};
  std::shared_ptr<const MotionEstimator> standard = MakeEstimator("standard");
  std::vector<Check> checks;
  for (const char* outlier_ratio : {"0.4", "0.5"}) {
    checks.push_back(MakeCheck(
        {{"scene", "uniform_volume"}, {"num_matches", "200"}, {"outlier_ratio", outlier_ratio}},
        [standard](Case& made) { return FlagStatistic(*standard, made); }, targets, kFlagDesign.limits));
  }
  return {{"flag.kappa", "eq::metric", "standard, kappa = 0.5",
           "n*_I / n_I <= kappa tells failed from good motions (90 % of either)",
           "the flag against rotation error > 3 deg or direction error > 15 deg", "outlier_ratio", checks}};
}

}  // namespace rcme
