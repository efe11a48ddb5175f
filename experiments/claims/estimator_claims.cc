#include <algorithm>

#include "experiments/claims/calibration.h"
#include "experiments/claims/call_estimator.h"
#include "experiments/claims/design.h"
#include "experiments/claims/families.h"

namespace rcme {

CaseClaim EstimatorCalibration(const std::string& label, const std::string& reading,
                               std::shared_ptr<const MotionEstimator> estimator,
                               const FailureBounds& bounds) {
  return {{"estimator.coverage." + label,
           "Sec. model selection, MLE",
           reading,
           "The covariance that comes with a motion within the failure bounds is that of its error",
           "NEES of the motions that are no failures, chi2_5; an answer that is not valid does not cover",
           "outlier_ratio",
           {}},
          [estimator, bounds](Case& made) { return ReportedCovarianceStatistic(*estimator, made, bounds); },
          ReportedCovarianceTargets(),
          kEstimatorCoverage.limits,
          {.num_true_matches = 0, .matches = MatchesOf::kPair},
          kDifficultyStatistic};
}

CaseClaim ProbabilityCalibration(const std::string& label, const std::string& reading,
                                 std::shared_ptr<const MotionEstimator> estimator,
                                 const FailureBounds& bounds) {
  return {{"estimator.probability." + label,
           "of one's own",
           reading,
           "Motions fail as often as their stated probabilities of failure say",
           "stated probability less 1 for a failure, 0 for none; and the failures among the sure answers",
           "outlier_ratio",
           {}},
          [estimator, bounds](Case& made) {
            return StatedProbabilityStatistic(CallEstimator(*estimator, made), bounds);
          },
          StatedProbabilityTargets(),
          kStatedProbability.limits,
          {.num_true_matches = 0, .matches = MatchesOf::kPair}};
}

bool StatesProbability(const std::string& estimator) {
  const std::unique_ptr<EstimatorModel> model = FindEstimator(estimator).make();
  return std::ranges::any_of(model->Parameters(), [](const Parameter& option) {
    return option.name() == "max_failure_probability";
  });
}

std::vector<Claim> EstimatorClaims(const std::vector<EstimatorEntry>& estimators) {
  std::vector<Claim> claims;
  for (const EstimatorEntry& entry : estimators) {
    const CaseClaim claim =
        EstimatorCalibration(entry.name, entry.name + ", defaults", entry.make()->Make(), FailureBounds());
    std::vector<Settings> settings;
    for (const char* outlier_ratio : {"0", "0.2"}) {
      settings.push_back({{"num_matches", "100"}, {"outlier_ratio", outlier_ratio}});
    }
    claims.push_back(OnBuiltInScene(claim, settings));
  }
  for (const EstimatorEntry& entry : estimators) {
    if (!StatesProbability(entry.name)) continue;
    claims.push_back(OnBuiltInScene(
        ProbabilityCalibration(entry.name, entry.name + ", defaults", entry.make()->Make(), FailureBounds()),
        {{{"num_matches", "100"}, {"outlier_ratio", "0.2"}},
         {{"num_matches", "100"}, {"outlier_ratio", "0.8"}}}));
  }
  return claims;
}

}  // namespace rcme
