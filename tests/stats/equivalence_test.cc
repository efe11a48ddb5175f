#include "stats/equivalence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "stats/confidence_sequence.h"
#include "stats/random.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

// P(the exact interval of n trials at `rate` gives this verdict): exact sum.
double ComputeProbability(Verdict verdict, int n, double rate, double nominal, double margin) {
  double sum = 0.0;
  for (int k = 0; k <= n; ++k) {
    const double log_p = std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) +
                         k * std::log(rate) + (n - k) * std::log1p(-rate);
    if (log_p < -50.0) continue;
    if (DecideEquivalence(ExactBinomialInterval(k, n), Around(nominal, margin)) == verdict)
      sum += std::exp(log_p);
  }
  return sum;
}

TEST(Equivalence, ByHand) {
  EXPECT_EQ(DecideEquivalence({0.94, 0.96}, Around(0.95, 0.02)), Verdict::kHolds);
  EXPECT_EQ(DecideEquivalence({0.75, 1.25}, Around(1.0, 0.25)),
            Verdict::kHolds);  // the borders belong to the margin
  EXPECT_EQ(DecideEquivalence({0.90, 0.96}, Around(0.95, 0.02)), Verdict::kUndecided);
  EXPECT_EQ(DecideEquivalence({0.0, 1.0}, Around(0.95, 0.02)), Verdict::kUndecided);  // no trials: no verdict
  EXPECT_EQ(DecideEquivalence({0.90, 0.92}, Around(0.95, 0.02)), Verdict::kDoesNotHold);
  EXPECT_EQ(DecideEquivalence({0.98, 0.99}, Around(0.95, 0.02)), Verdict::kDoesNotHold);
  EXPECT_EQ(DecideEquivalence({0.75, 0.75}, Around(1.0, 0.25)), Verdict::kHolds);
  // What touches the border may be on it.
  EXPECT_EQ(DecideEquivalence({0.25, 0.75}, Around(1.0, 0.25)), Verdict::kUndecided);
  EXPECT_EQ(DecideEquivalence({1.25, 1.75}, Around(1.0, 0.25)), Verdict::kUndecided);
  EXPECT_EQ(DecideEquivalence({std::nan(""), 0.96}, Around(0.95, 0.02)), Verdict::kUndecided);
  EXPECT_EQ(DecideEquivalence({0.94, std::nan("")}, Around(0.95, 0.02)), Verdict::kUndecided);
  EXPECT_STREQ(Name(Verdict::kHolds), "holds");
  EXPECT_STREQ(Name(Verdict::kDoesNotHold), "does not hold");
  EXPECT_STREQ(Name(Verdict::kUndecided), "undecided");
}

TEST(Equivalence, WrongVerdictsAreAsRareAsTheIntervalSays) {
  // Exact: on the border (the worst case) each wrong verdict has probability at most 0.025, and not much
  // less. Absence of evidence is no evidence: with 100 trials a rate of 0.9 is never called equivalent to
  // 0.95 +- 0.02.
  for (const double border : {0.93, 0.97}) {
    EXPECT_LE(ComputeProbability(Verdict::kHolds, 5000, border, 0.95, 0.02), 0.025);
    EXPECT_GT(ComputeProbability(Verdict::kHolds, 5000, border, 0.95, 0.02), 0.015);
    EXPECT_LE(ComputeProbability(Verdict::kDoesNotHold, 5000, border, 0.95, 0.02), 0.025);
    EXPECT_GT(ComputeProbability(Verdict::kDoesNotHold, 5000, border, 0.95, 0.02), 0.015);
  }
  EXPECT_EQ(ComputeProbability(Verdict::kHolds, 100, 0.95, 0.95, 0.02), 0.0);
  EXPECT_GT(ComputeProbability(Verdict::kUndecided, 100, 0.95, 0.95, 0.02), 0.9);
}

TEST(TrialsToDecide, DecidesWithThePowerAskedFor) {
  // Exact power at the promised number of trials, 0.9 asked: from 0.87 (the exact
  // interval is wider than the normal one) to 0.98 (few trials).
  const struct {
    double rate, nominal, margin;
    Verdict verdict;
  } kCases[] = {
      {0.95, 0.95, 0.02, Verdict::kHolds},
      {0.94, 0.95, 0.02, Verdict::kHolds},
      {0.90, 0.95, 0.02, Verdict::kDoesNotHold},
      {0.50, 0.95, 0.02, Verdict::kDoesNotHold},
      {0.06, 0.05, 0.03, Verdict::kHolds},
      {0.999, 0.99, 0.02, Verdict::kHolds}};  // the upper border is beyond 1: only one can be crossed
  for (const auto& each : kCases) {
    const int n = static_cast<int>(std::ceil(TrialsToDecide(each.rate, Around(each.nominal, each.margin))));
    const double power = ComputeProbability(each.verdict, n, each.rate, each.nominal, each.margin);
    EXPECT_GT(power, 0.86) << "rate " << each.rate << ", n = " << n;
    RecordProperty("power_at_" + std::to_string(each.rate),
                   std::to_string(power) + " n=" + std::to_string(n));
    // Half as many are too few, where the normal term decides.
    if (n > 300) {
      EXPECT_LT(ComputeProbability(each.verdict, n / 2, each.rate, each.nominal, each.margin), 0.75)
          << each.rate;
    }
  }
  // By hand, 1.281552 and 1.644854 the normal quantiles of 0.9 and 0.95: (1.959964 + 1.644854)^2 * 0.95 *
  // 0.05 / 0.02^2 = 1543.1, and (1.959964 + 1.281552)^2 * 0.9 * 0.1 / 0.03^2 = 1050.7.
  EXPECT_NEAR(TrialsToDecide(0.95, Around(0.95, 0.02)), 1543.1, 0.1);
  EXPECT_NEAR(TrialsToDecide(0.90, Around(0.95, 0.02)), 1050.7, 0.1);
  EXPECT_EQ(TrialsToDecide(0.25, Around(0.5, 0.25)),
            std::numeric_limits<double>::infinity());  // on the border
}

TEST(Equivalence, StoppingAtTheFirstVerdictIsSafeOnlyWithAConfidenceSequence) {
  // A study of 3000 trials that looks every 25 and stops as soon as it may say "holds", of a rate on the
  // border: 2000 repetitions. Also how long the sequence takes at the nominal rate.
  CoverageCount sequence_wrong, exact_wrong;
  for (std::uint32_t repetition = 0; repetition < 2000; ++repetition) {
    RandomStream rng({.seed = 1, .trial = repetition, .purpose = 130});
    bool sequence_holds = false, exact_holds = false;
    std::int64_t successes = 0;
    for (int n = 1; n <= 3000; ++n) {
      successes += rng.Uniform() < 0.90 ? 1 : 0;
      if (n % 25 != 0) continue;
      sequence_holds = sequence_holds || DecideEquivalence(ConfidenceSequence(successes, n),
                                                           Around(0.95, 0.05)) == Verdict::kHolds;
      exact_holds = exact_holds || DecideEquivalence(ExactBinomialInterval(successes, n),
                                                     Around(0.95, 0.05)) == Verdict::kHolds;
    }
    sequence_wrong.Add(sequence_holds);
    exact_wrong.Add(exact_holds);
  }
  EXPECT_LT(sequence_wrong.interval().upper, 0.05) << sequence_wrong;
  EXPECT_GT(exact_wrong.interval().lower, 0.05) << exact_wrong;
  RecordProperty("sequence", std::to_string(sequence_wrong.rate()));
  RecordProperty("exact", std::to_string(exact_wrong.rate()));
}

TEST(TrialsToDecide, AConfidenceSequenceNeedsTwoToThreeTimesAsMany) {
  std::vector<int> needed;
  for (std::uint32_t repetition = 0; repetition < 400; ++repetition) {
    RandomStream rng({.seed = 1, .trial = repetition, .purpose = 131});
    std::int64_t successes = 0;
    for (int n = 1;; ++n) {
      successes += rng.Uniform() < 0.95 ? 1 : 0;
      if (n % 25 == 0 &&
          DecideEquivalence(ConfidenceSequence(successes, n), Around(0.95, 0.02)) == Verdict::kHolds) {
        needed.push_back(n);
        break;
      }
    }
  }
  std::sort(needed.begin(), needed.end());
  const double promised = TrialsToDecide(0.95, Around(0.95, 0.02));
  EXPECT_GT(needed[360], 1.8 * promised);  // the 90 % quantile
  EXPECT_LT(needed[360], 3.2 * promised);
  RecordProperty("ratio_at_90_percent", std::to_string(needed[360] / promised));
}

}  // namespace
}  // namespace rcme
