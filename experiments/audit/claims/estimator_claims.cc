#include "experiments/audit/claims/calibration.h"
#include "experiments/audit/claims/call_estimator.h"
#include "experiments/audit/claims/design.h"
#include "experiments/audit/claims/families.h"

namespace rcme {

CaseClaim EstimatorCalibration(const std::string& label, const std::string& reading,
                               std::shared_ptr<const MotionEstimator> estimator,
                               const FailureBounds& bounds) {
  return {
      {"estimator.coverage." + label,
       "Sec. model selection, MLE",
       reading,
       "The covariance of a motion within the failure bounds is that of its error",
       "NEES of the motions that are no failures, chi2_5; that of an answer that is not valid is infinite",
       "outlier_ratio",
       {}},
      [estimator, bounds](Case& made) { return ReportedCovarianceStatistic(*estimator, made, bounds); },
      ReportedCovarianceTargets(),
      kEstimatorCoverage.limits,
      {.num_true_matches = 0, .matches = MatchesOf::kPair},
      kDifficultyStatistic};
}

CaseClaim FailureCalibration(const std::string& label, const std::string& reading,
                             std::shared_ptr<const MotionEstimator> estimator, const FailureBounds& bounds) {
  return {
      {"estimator.failures." + label,
       "of one's own",
       reading,
       "Sure motions fail no more often than stated, and stated probabilities are right",
       "1 for a failure, 0 for none, less its probability as the answer states it, or as follows from its "
       "covariance, where that is small; of stated ones also all, both ways",
       "outlier_ratio",
       {}},
      [estimator, bounds](Case& made) { return StatedFailureStatistic(*estimator, made, bounds); },
      StatedFailureTargets(),
      kFailures.limits,
      {.num_true_matches = 0, .matches = MatchesOf::kPair}};
}

CaseClaim SigmaCalibration(const std::string& label, const std::string& reading,
                           std::shared_ptr<const MotionEstimator> estimator) {
  return {
      {"estimator.sigma." + label,
       "of one's own",
       reading,
       "The stated noise level is that of the matches, up to its standard deviation",
       "stated over true sigma, less 1; its squared error over the stated variance, chi2_1",
       "outlier_ratio",
       {}},
      [estimator](Case& made) { return SigmaStatistic(CallEstimator(*estimator, made), made.sigma_px_true); },
      StatedSigmaTargets(),
      kStatedSigma.limits,
      {.num_true_matches = 0, .matches = MatchesOf::kPair, .true_motion = false},
      std::nullopt,
      "no answer states sigma"};
}

std::vector<CaseClaim> AnswerCalibration(const std::string& label, const std::string& reading,
                                         std::shared_ptr<const MotionEstimator> estimator,
                                         const FailureBounds& bounds) {
  return {EstimatorCalibration(label, reading, estimator, bounds),
          FailureCalibration(label, reading, estimator, bounds), SigmaCalibration(label, reading, estimator)};
}

std::vector<Claim> EstimatorClaims(const std::vector<EstimatorEntry>& estimators) {
  const auto settings_with = [](const std::vector<const char*>& outlier_ratios) {
    std::vector<Settings> settings;
    for (const char* ratio : outlier_ratios)
      settings.push_back({{"num_matches", "100"}, {"outlier_ratio", ratio}});
    return settings;
  };
  std::vector<Claim> claims;
  for (const EstimatorEntry& entry : estimators) {
    const std::vector<CaseClaim> answers =
        AnswerCalibration(entry.name, entry.name + ", defaults", entry.make()->Make(), FailureBounds());
    claims.push_back(OnBuiltInScene(answers[0], settings_with({"0", "0.2"})));
    claims.push_back(OnBuiltInScene(answers[1], settings_with({"0.2", "0.8"})));
    claims.push_back(OnBuiltInScene(answers[2], settings_with({"0.2"})));
  }
  return claims;
}

}  // namespace rcme
