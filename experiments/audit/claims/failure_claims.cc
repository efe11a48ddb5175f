#include "experiments/audit/claims/call_estimator.h"
#include "experiments/audit/claims/design.h"
#include "experiments/audit/claims/families.h"

namespace rcme {
namespace {

// Standard, pRCME and RCME on the same matches with the same stream of samples.
struct Rivals {
  std::shared_ptr<const MotionEstimator> standard, prcme, rcme;
};

// pRCME and RCME with these options, and standard with the tests of its motion at `test_level`.
Rivals MakeRivals(const Settings& options, const char* test_level) {
  return {MakeEstimator("standard", {{"observability_significance_level", test_level},
                                     {"chance_significance_level", test_level}}),
          MakeEstimator("prcme", options), MakeEstimator("rcme", options)};
}

// What counts as a failure: a wrong motion, or also a refusal ("Detect-fail").
struct FailureRule {
  std::string id, words;
  bool (*fails)(const TrialRecord& record);
};

Outcome OrderStatistic(const Rivals& rivals, const FailureRule& rule, const Case& made) {
  const TrialRecord standard = CallEstimator(*rivals.standard, made);
  const TrialRecord prcme = CallEstimator(*rivals.prcme, made);
  const TrialRecord rcme = CallEstimator(*rivals.rcme, made);
  const bool standard_fails = rule.fails(standard), prcme_fails = rule.fails(prcme),
             rcme_fails = rule.fails(rcme);
  Outcome outcome = {OnlyFirst(prcme_fails, rcme_fails), OnlyFirst(standard_fails, prcme_fails),
                     OnlyFirst(standard_fails, rcme_fails)};
  for (const TrialRecord* record : {&standard, &prcme, &rcme}) {
    outcome.push_back(FailsSilently(*record) ? 1.0 : 0.0);
    outcome.push_back(HasRefused(*record) ? 1.0 : 0.0);
  }
  return outcome;
}

Claim OrderClaim(const std::string& id, const std::string& reading, const Rivals& rivals,
                 const FailureRule& rule) {
  const std::string discordant = "of trials that tell them apart, fails ";
  std::vector<Target> targets = {PlannedRate(discordant + "pRCME, not RCME", 1.0, kFailureOrder, 0),
                                 PlannedRate(discordant + "standard, not pRCME", 1.0, kFailureOrder, 1),
                                 MeasuredRate(discordant + "standard, not RCME", 2)};
  for (const std::string name : {"standard", "pRCME", "RCME"}) {
    targets.push_back(MeasuredRate(name + " fails", targets.size()));
    targets.push_back(MeasuredRate(name + " is refused", targets.size()));
  }
  const auto statistic = [rivals, rule](Case& made) { return OrderStatistic(rivals, rule, made); };
  return {
      "failure.order." + id + rule.id,
      "Tab. real-data-test",
      reading + ", " + rule.words,
      "RCME fails less often than pRCME, and pRCME than standard",
      "rotation error > 3 deg or direction error > 15 deg, in pairs, by the trials in which only one fails",
      "",
      {MakeCheck({{"num_matches", "200"}, {"outlier_ratio", "0.4"}}, statistic, targets,
                 kFailureOrder.limits)}};
}

Claim AgainstStandardClaim(const EstimatorEntry& entry) {
  Claim claim{"failure." + entry.name,
              "of one's own",
              entry.name + ", defaults",
              entry.name + " fails or refuses at most 5 percentage points more often than standard",
              "rotation error > 3 deg or direction error > 15 deg, in pairs",
              "outlier_ratio",
              {}};
  std::shared_ptr<const MotionEstimator> standard = MakeEstimator("standard");
  std::shared_ptr<const MotionEstimator> other = entry.make()->Make();
  const auto statistic = [standard, other](Case& made) -> Outcome {
    const bool standard_fails = FailsOrRefuses(CallEstimator(*standard, made));
    const bool other_fails = FailsOrRefuses(CallEstimator(*other, made));
    return {1.0 * other_fails - 1.0 * standard_fails, 1.0 * other_fails, 1.0 * standard_fails};
  };
  for (const char* outlier_ratio : {"0.2", "0.3", "0.4"}) {
    claim.checks.push_back(
        MakeCheck({{"num_matches", "200"}, {"outlier_ratio", outlier_ratio}}, statistic,
                  {PlannedBoundedMean("failure rate less that of standard", 0.0,
                                      {-1.0, kAgainstStandard.margin}, {-1.0, 1.0}, kAgainstStandard, 0),
                   MeasuredRate(entry.name + " fails or is refused", 1),
                   MeasuredRate("standard fails or is refused", 2)},
                  kAgainstStandard.limits));
  }
  return claim;
}

}  // namespace

std::vector<Claim> FailureClaims(const std::vector<EstimatorEntry>& estimators) {
  const Rivals as_printed = MakeRivals({}, "off");
  const Rivals rank_aware = MakeRivals({{"reading", "rank_aware"}}, "0.001");
  const Rivals predictive =
      MakeRivals({{"reading", "rank_aware"}, {"selection", "predictive_likelihood"}}, "0.001");
  const FailureRule silent{"", "refusals are no failures", FailsSilently};
  const FailureRule any{"_or_refusal", "refusals are failures", FailsOrRefuses};
  std::vector<Claim> claims = {
      OrderClaim("as_printed", "as printed", as_printed, silent),
      OrderClaim("as_printed", "as printed", as_printed, any),
      OrderClaim("rank_aware", "rank-aware, least entropy", rank_aware, silent),
      OrderClaim("predictive", "rank-aware, predictive likelihood", predictive, silent)};
  for (const EstimatorEntry& entry : estimators) {
    if (entry.name != "standard" && entry.name != "prcme" && entry.name != "rcme") {
      claims.push_back(AgainstStandardClaim(entry));
    }
  }
  return claims;
}

}  // namespace rcme
