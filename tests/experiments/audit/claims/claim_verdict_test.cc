#include "experiments/audit/claims/claim_verdict.h"

#include <gtest/gtest.h>

namespace rcme {
namespace {

constexpr Verdict kYes = Verdict::kHolds, kNo = Verdict::kDoesNotHold, kOpen = Verdict::kUndecided;

TEST(Together, OneFailureDecidesAndOneOpenQuestionLeavesOpen) {
  EXPECT_EQ(Together({}), std::nullopt);
  EXPECT_EQ(Together({std::nullopt, std::nullopt}), std::nullopt);
  EXPECT_EQ(Together({kYes, std::nullopt, kYes}), kYes);
  EXPECT_EQ(Together({kYes, kOpen, kYes}), kOpen);
  EXPECT_EQ(Together({kOpen, kYes}), kOpen);
  EXPECT_EQ(Together({kOpen, kNo, kYes}), kNo);
}

struct NoiseLevel {
  double sigma_px;
  std::optional<Verdict> verdict;
};

ClaimResult Judge(const std::vector<NoiseLevel>& noise_levels) {
  Claim claim;
  ClaimResult result;
  for (const NoiseLevel& noise_level : noise_levels) {
    claim.checks.emplace_back().sigma_px = noise_level.sigma_px;
    result.checks.emplace_back().verdict = noise_level.verdict;
  }
  JudgeClaim(claim, &result);
  return result;
}

TEST(JudgeClaim, HoldsIfItHoldsUpToTheAssertedNoise) {
  const ClaimResult result = Judge({{0.01, kYes}, {0.5, kYes}, {1.0, kNo}});
  EXPECT_EQ(result.verdict, ClaimVerdict::kHolds);
  EXPECT_EQ(result.holds_up_to_sigma_px, 0.5);
}

TEST(JudgeClaim, HoldsInTheLimitOnlyIfItFailsByThen) {
  const ClaimResult result = Judge({{0.5, kNo}, {1e-4, kYes}, {1e-3, kYes}, {0.1, kOpen}});  // in any order
  EXPECT_EQ(result.verdict, ClaimVerdict::kSmallNoiseOnly);
  EXPECT_EQ(result.holds_up_to_sigma_px, 1e-3);
}

TEST(JudgeClaim, FailsIfItFailsInTheLimit) {
  EXPECT_EQ(Judge({{1e-4, kNo}, {0.5, kYes}}).verdict, ClaimVerdict::kDoesNotHold);
  EXPECT_EQ(Judge({{0.5, kNo}}).verdict, ClaimVerdict::kDoesNotHold);
  EXPECT_EQ(Judge({{1.0, kNo}}).verdict,
            ClaimVerdict::kDoesNotHold);  // checked only above the asserted noise
  EXPECT_FALSE(Judge({{0.5, kNo}}).holds_up_to_sigma_px);
}

TEST(JudgeClaim, WithOneNoiseLevelHoldsIfItHoldsInEveryCondition) {
  const auto judge = [](const std::vector<std::optional<Verdict>>& verdicts) {
    Claim claim;
    ClaimResult result;
    for (const std::optional<Verdict>& verdict : verdicts) {
      claim.checks.emplace_back().sigma_px.reset();
      result.checks.emplace_back().verdict = verdict;
      if (!verdict) result.checks.back().not_possible = "fewer than 8 true matches";
    }
    JudgeClaim(claim, &result);
    EXPECT_FALSE(result.holds_up_to_sigma_px);
    return result.verdict;
  };
  EXPECT_EQ(judge({kYes, kYes}), ClaimVerdict::kHolds);
  EXPECT_EQ(judge({kYes, std::nullopt}), ClaimVerdict::kHolds);
  EXPECT_EQ(judge({kYes, kNo}), ClaimVerdict::kDoesNotHold);
  EXPECT_EQ(judge({kNo, kYes}), ClaimVerdict::kDoesNotHold);
  EXPECT_EQ(judge({kYes, kOpen}), ClaimVerdict::kUndecided);
  EXPECT_EQ(judge({std::nullopt, std::nullopt}), ClaimVerdict::kNotPossible);
}

// Catches sides exchanged, of a coverage or of its law's mean, and one of a rate that is no region's.
TEST(FindFailedSide, ARegionThatCoversTooSeldomIsTooNarrow) {
  Target coverage = ClaimedRate("coverage", 0.95, {0.94, 0.96});
  coverage.kind = Target::Kind::kCoverage;
  const auto side = [](const Target& target, const Interval& interval) {
    TargetResult result;
    result.interval = interval;
    result.verdict = DecideEquivalence(interval, target.allowed);
    return FindFailedSide(target, result);
  };
  EXPECT_EQ(side(coverage, {0.5, 0.6}), std::nullopt) << "a share within a threshold, of no region";
  coverage.degrees_of_freedom = 5;
  EXPECT_EQ(side(coverage, {0.5, 0.6}), Side::kTooNarrow);
  EXPECT_EQ(side(coverage, {0.97, 0.98}), Side::kTooWide);
  EXPECT_EQ(side(coverage, {0.945, 0.955}), std::nullopt);
  EXPECT_EQ(side(coverage, {0.9, 0.98}), std::nullopt) << "undecided";
  Target pit = coverage;
  pit.kind = Target::Kind::kMeanPit;
  EXPECT_EQ(side(pit, {0.5, 0.6}), Side::kTooWide);
  EXPECT_EQ(side(pit, {0.97, 0.98}), Side::kTooNarrow);
  EXPECT_EQ(JoinSides({std::nullopt, Side::kTooWide, Side::kTooWide}), Side::kTooWide);
  EXPECT_EQ(JoinSides({Side::kTooNarrow, std::nullopt, Side::kTooWide}), Side::kBoth);
  EXPECT_EQ(JoinSides({std::nullopt}), std::nullopt);
}

TEST(JudgeClaim, IsUndecidedWithoutEvidence) {
  EXPECT_EQ(Judge({{0.5, kOpen}}).verdict, ClaimVerdict::kUndecided);
  EXPECT_EQ(Judge({{1e-4, kOpen}, {0.5, kNo}}).verdict, ClaimVerdict::kUndecided);  // limit or nowhere?
  EXPECT_EQ(Judge({{1e-4, kYes}, {0.5, kOpen}}).verdict, ClaimVerdict::kUndecided);
  EXPECT_EQ(Judge({{0.5, std::nullopt}}).verdict, ClaimVerdict::kMeasured);
}

TEST(JudgeClaim, ChecksOfOneNoiseLevelStandTogether) {
  EXPECT_EQ(Judge({{0.5, kYes}, {0.5, kNo}, {0.5, std::nullopt}}).verdict, ClaimVerdict::kDoesNotHold);
  EXPECT_EQ(Judge({{0.5, kYes}, {0.5, kYes}}).verdict, ClaimVerdict::kHolds);
  EXPECT_EQ(Judge({{0.1, kYes}, {0.1, kOpen}, {0.5, kYes}}).verdict, ClaimVerdict::kUndecided);
}

}  // namespace
}  // namespace rcme
