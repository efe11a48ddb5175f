#include "estimator/ransac_options.h"
#include "experiments/audit/claims/call_estimator.h"
#include "experiments/audit/claims/design.h"
#include "experiments/audit/claims/families.h"

namespace rcme {
namespace {

// `mu`: the default of the reading.
Claim EarlyStopClaim(const std::string& reading, const std::string& mu, const std::string& name) {
  std::shared_ptr<const MotionEstimator> all = MakeEstimator("rcme", {{"reading", reading}});
  std::shared_ptr<const MotionEstimator> early =
      MakeEstimator("rcme", {{"reading", reading}, {"early_stop_entropy", mu}});
  const double num_iterations = RansacOptions().num_iterations;
  const auto statistic = [all, early, num_iterations](Case& made) -> Outcome {
    const TrialRecord of_all = CallEstimator(*all, made), of_early = CallEstimator(*early, made);
    const bool all_fails = FailsOrRefuses(of_all), early_fails = FailsOrRefuses(of_early);
    return {early_fails && !all_fails ? 1.0 : 0.0, 1.0 - of_early.counts.num_hypotheses / num_iterations,
            1.0 * all_fails, 1.0 * early_fails};
  };
  return {"early_stop." + reading,
          "Sec. early-terminate",
          name,
          "Stopping at psi <= mu saves at least 10 % of the hypotheses and costs at most 1 % of the "
          "trials",
          "hypotheses not drawn; trials in which only the early one fails or refuses",
          "outlier_ratio",
          {MakeCheck({{"num_matches", "200"}, {"outlier_ratio", "0.3"}}, statistic,
                     {PlannedRate("only the early one fails", 0.0, kEarlyStopCost, 0),
                      PlannedBoundedMean("share of hypotheses saved", 1.0, {0.1, 1.0}, {0.0, 1.0},
                                         kEarlyStopSaving, 1),
                      MeasuredRate("all hypotheses: fails or is refused", 2),
                      MeasuredRate("early stop: fails or is refused", 3)},
                     kEarlyStopCost.limits)}};
}

}  // namespace

std::vector<Claim> EarlyStopClaims() {
  return {EarlyStopClaim("as_printed", "-3.53", "as printed, at -3.53"),
          EarlyStopClaim("rank_aware", "6", "rank-aware, at 6 nats")};
}

}  // namespace rcme
