#include "experiments/audit/claims/power.h"

#include <gtest/gtest.h>

#include <cmath>

#include "experiments/audit/claims/audit.h"
#include "experiments/audit/claims/case.h"
#include "experiments/audit/claims/claim_table.h"
#include "experiments/audit/claims/decide_check.h"
#include "experiments/audit/claims/design.h"
#include "stats/distributions.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

// A check of the law chi2_k where the assumed sigma has a relative error.
Check LawCheck(int degrees_of_freedom, double sigma_error, const std::vector<Target>& targets,
               std::int64_t trials) {
  Check check;
  check.targets = targets;
  check.limits = {trials, trials, trials};
  check.trial = [degrees_of_freedom, sigma_error](const StreamName& name) -> Outcome {
    RandomStream rng(name);
    double sum = 0.0;
    for (int i = 0; i < degrees_of_freedom; ++i) sum += std::pow(rng.Normal() / (1.0 + sigma_error), 2.0);
    return {sum};
  };
  return check;
}

CoverageCount CountWithVerdict(Verdict verdict, const Check& check, double confidence, int num_seeds) {
  CoverageCount count;
  for (int seed = 1; seed <= num_seeds; ++seed) {
    count.Add(DecideCheck(check, {static_cast<std::uint64_t>(seed), 3, Budget::kQuick, confidence}).verdict ==
              verdict);
  }
  return count;
}

// The ranges by integration over the law instead of F_{k,k}, and for k = 2 in closed form: E exp(-x / 2c) =
// c / (1 + c).
TEST(MeanPitWithin, IsWhatAWrongSigmaDoesToTheMean) {
  for (const int degrees_of_freedom : {1, 2, 3, 5, 8}) {
    const Interval range = MeanPitWithin(degrees_of_freedom, 0.1);
    double mean = 0.0;  // of F(x / 1.1^2)
    constexpr int kSteps = 4'000;
    for (int i = 0; i < kSteps; ++i) {
      const double x = ChiSquareQuantile(degrees_of_freedom, (i + 0.5) / kSteps);
      mean += ChiSquareCdf(degrees_of_freedom, x / 1.21) / kSteps;
    }
    EXPECT_NEAR(range.lower, mean, 1e-4) << degrees_of_freedom;
    EXPECT_NEAR(range.lower + range.upper, 1.0, 1e-12);
  }
  EXPECT_NEAR(MeanPitWithin(2, 0.1).upper, 1.21 / 2.21, 1e-12);
  EXPECT_NEAR(CoverageWithin(2, 0.05, 0.1).upper, 1.0 - std::pow(0.05, 1.21), 1e-12);
  EXPECT_NEAR(CoverageWithin(2, 0.05, 0.1).lower, 1.0 - std::pow(0.05, 1.0 / 1.21), 1e-12);
}

// What is promised is kept: by running checks at the nominal value and at the departure that is said to be
// found. (A check that looks once, at its last trial, as the promise is made.)
TEST(FindPower, IsThePowerThatChecksHave) {
  constexpr double kPowerConfidence = 0.999;
  constexpr int kTrials = 2'000, kSeeds = 60;
  for (const Target& target : {CoverageTargets(5).front(), CoverageTargets(5).back()}) {
    const TargetPower power = FindPower(target, kTrials, kPowerConfidence);
    const CoverageCount holds =
        CountWithVerdict(Verdict::kHolds, LawCheck(5, 0.0, {target}, kTrials), kPowerConfidence, kSeeds);
    EXPECT_TRUE(holds.Admits(power.holds_at_nominal))
        << target.quantity << power.holds_at_nominal << ", " << holds;
    for (const double error : {power.found_sigma.lower, power.found_sigma.upper}) {
      const CoverageCount found = CountWithVerdict(
          Verdict::kDoesNotHold, LawCheck(5, error, {target}, kTrials), kPowerConfidence, kSeeds);
      EXPECT_TRUE(found.Admits(kPowerOfDesign)) << target.quantity << " at " << error << ": " << found;
    }
  }
}

TEST(FindPower, SaysWhenNothingCanBeDecided) {
  const TargetPower power = FindPower(ClaimedRate("rate", 0.5, {0.49, 0.51}), 100, 0.999);
  EXPECT_EQ(power.holds_at_nominal, 0.0);
  EXPECT_LT(power.found.lower, 0.4);
  const TargetPower one_sided = FindPower(ClaimedRate("rate", 1.0, {0.9, 1.0}), 1'000, 0.999);
  EXPECT_EQ(one_sided.holds_at_nominal, 1.0);
  EXPECT_TRUE(std::isinf(one_sided.found.upper));
  EXPECT_EQ(DescribeFound(one_sided).find(" or "), std::string::npos);
  EXPECT_EQ(DescribeFound(FindPower(ClaimedRate("rate", 1.0, {0.9, 1.0}), 2, 0.999)), "nothing");
}

// The whole table: at either budget every claim can hold where everything is nominal, and can fail.
TEST(Design, EveryClaimCanHoldAndEveryTargetCanFail) {
  for (const Budget budget : {Budget::kQuick, Budget::kFull}) {
    AuditOptions options;
    options.budget = budget;
    const Audit plan = PlanAudit(AllClaims(EstimatorRegistry()), options);
    for (const Claim& claim : plan.claims) {
      EXPECT_GE(HoldsAtNominal(claim, budget, plan.confidence), kPowerOfDesign) << claim.id;
      for (const Check& check : claim.checks) {
        for (const Target& target : check.targets) {
          if (!target.IsClaimed()) continue;
          const TargetPower power = FindPower(target, check.limits.Max(budget), plan.confidence);
          EXPECT_TRUE(std::isfinite(power.found.lower) || std::isfinite(power.found.upper))
              << claim.id << ": " << target.quantity << " cannot fail";
        }
      }
    }
  }
}

// The full budget finds 5 %, either way, of a motion's covariance and of a point's.
TEST(Design, FullFindsASigmaThatIsFivePercentWrong) {
  const Audit plan = PlanAudit(AllClaims(EstimatorRegistry()), {});
  for (const auto& [degrees_of_freedom, limits] :
       {std::pair{5, kReprojectionCoverage.limits}, std::pair{1, kSampleCoverage.limits}}) {
    const Target pit = CoverageTargets(degrees_of_freedom).back();
    const TargetPower full = FindPower(pit, limits.full, plan.confidence);
    EXPECT_GT(full.found_sigma.lower, -0.05) << degrees_of_freedom;
    EXPECT_LT(full.found_sigma.upper, 0.05) << degrees_of_freedom;
  }
}

// The quick budget finds 8 % of an estimator's covariance, either way.
TEST(Design, QuickFindsAnEstimatorsSigmaThatIsEightPercentWrong) {
  const Audit plan = PlanAudit(AllClaims(EstimatorRegistry()), {});
  const Target pit = CoverageTargets(5, kEstimatorTolerance).back();
  const TargetPower quick = FindPower(pit, kEstimatorCoverage.limits.quick, plan.confidence);
  EXPECT_GT(quick.found_sigma.lower, -0.08);
  EXPECT_LT(quick.found_sigma.upper, 0.08);
}

}  // namespace
}  // namespace rcme
