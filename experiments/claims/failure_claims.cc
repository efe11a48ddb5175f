#include "experiments/claims/call_estimator.h"
#include "experiments/claims/families.h"
#include "experiments/claims/limits.h"

namespace rcme {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Standard, pRCME and RCME on the same matches with the same stream of samples.
struct Rivals {
  std::shared_ptr<const MotionEstimator> standard, prcme, rcme;
};

Rivals MakeRivals(const RansacOptions& options) {
  return {FindEstimator("standard").make(options), FindEstimator("prcme").make(options),
          FindEstimator("rcme").make(options)};
}

Outcome OrderStatistic(const Rivals& rivals, const Case& made) {
  const TrialRecord standard = CallEstimator(*rivals.standard, made);
  const TrialRecord prcme = CallEstimator(*rivals.prcme, made);
  const TrialRecord rcme = CallEstimator(*rivals.rcme, made);
  Outcome outcome;
  for (const auto fails : {FailsSilently, FailsOrRefuses}) {
    outcome.push_back(OnlyFirst(fails(prcme), fails(rcme)));
    outcome.push_back(OnlyFirst(fails(standard), fails(prcme)));
    outcome.push_back(OnlyFirst(fails(standard), fails(rcme)));
  }
  for (const auto fails : {FailsSilently, FailsOrRefuses}) {
    for (const TrialRecord* record : {&standard, &prcme, &rcme}) outcome.push_back(fails(*record));
  }
  return outcome;
}

std::vector<Target> OrderTargets() {
  std::vector<Target> targets;
  for (const std::string refusals : {" (refusals are no failures)", " (refusals are failures)"}) {
    for (const std::string pair : {"pRCME, not RCME", "standard, not pRCME", "standard, not RCME"}) {
      targets.push_back({"of trials that tell them apart, fails " + pair + refusals,
                         Target::Kind::kRate,
                         1.0,
                         {0.5, 1.0},
                         kNaN,
                         targets.size()});
    }
  }
  for (const std::string refusals : {"", " or is refused"}) {
    for (const std::string name : {"standard", "pRCME", "RCME"}) {
      targets.push_back({name + " fails" + refusals, Target::Kind::kRate, kNaN, {}, kNaN, targets.size()});
    }
  }
  return targets;
}

Claim OrderClaim(const std::string& id, const std::string& reading, const RansacOptions& options) {
  Claim claim{
      "failure.order." + id,
      "Tab. real-data-test",
      reading,
      "RCME fails less often than pRCME, and pRCME less often than standard",
      "rotation error > 3 deg or direction error > 15 deg, in pairs, by the trials in which only one fails",
      "outlier_ratio",
      {}};
  for (const char* outlier_ratio : {"0.4"}) {
    claim.checks.push_back(MakeCheck(
        {{"num_matches", "200"}, {"outlier_ratio", outlier_ratio}},
        [rivals = MakeRivals(options)](Case& made) { return OrderStatistic(rivals, made); }, OrderTargets(),
        kEstimatorCalls));
  }
  return claim;
}

Claim AgainstStandardClaim(const EstimatorEntry& entry) {
  Claim claim{
      "failure." + entry.name,
      "",
      entry.name + ", defaults",
      entry.name + " fails or refuses no more often than standard",
      "rotation error > 3 deg or direction error > 15 deg, in pairs, by the trials in which only one fails",
      "outlier_ratio",
      {}};
  std::shared_ptr<const MotionEstimator> standard = FindEstimator("standard").make(RansacOptions());
  std::shared_ptr<const MotionEstimator> other = entry.make(RansacOptions());
  const auto statistic = [standard, other](Case& made) -> Outcome {
    const bool standard_fails = FailsOrRefuses(CallEstimator(*standard, made));
    const bool other_fails = FailsOrRefuses(CallEstimator(*other, made));
    return {OnlyFirst(other_fails, standard_fails), 1.0 * other_fails, 1.0 * standard_fails};
  };
  for (const char* outlier_ratio : {"0.2", "0.3", "0.4"}) {
    claim.checks.push_back(
        MakeCheck({{"num_matches", "200"}, {"outlier_ratio", outlier_ratio}}, statistic,
                  {{"of trials that tell them apart, fails " + entry.name,
                    Target::Kind::kRate,
                    0.5,
                    {0.0, 0.5},
                    kNaN,
                    0},
                   {entry.name + " fails or is refused", Target::Kind::kRate, kNaN, {}, kNaN, 1},
                   {"standard fails or is refused", Target::Kind::kRate, kNaN, {}, kNaN, 2}},
                  kEstimatorCalls));
  }
  return claim;
}

}  // namespace

std::vector<Claim> FailureClaims(const std::vector<EstimatorEntry>& estimators) {
  RansacOptions rank_aware, predictive;
  rank_aware.reading = predictive.reading = Reading::kRankAware;
  predictive.selection = Selection::kPredictiveLikelihood;
  std::vector<Claim> claims = {OrderClaim("as_printed", "as printed", RansacOptions()),
                               OrderClaim("rank_aware", "rank-aware, least entropy", rank_aware),
                               OrderClaim("predictive", "rank-aware, predictive likelihood", predictive)};
  for (const EstimatorEntry& entry : estimators) {
    if (entry.name != "standard" && entry.name != "prcme" && entry.name != "rcme") {
      claims.push_back(AgainstStandardClaim(entry));
    }
  }
  return claims;
}

}  // namespace rcme
