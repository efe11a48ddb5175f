// Answers drawn from a law: how wrong they are depends on what is seen of them, and on their group.
#include "experiments/conform/fit_rule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiments/conform/conform_output.h"
#include "experiments/conform/conform_report.h"
#include "parameters/input_error.h"
#include "stats/constants.h"
#include "stats/distributions.h"
#include "stats/forecast.h"
#include "stats/intervals.h"
#include "stats/random.h"

namespace rcme {
namespace {

constexpr size_t kAgreeing = static_cast<size_t>(VisibleFeature::kAgreeing),
                 kStated = static_cast<size_t>(VisibleFeature::kStatedOdds);

// x = log(1 + agreeing matches) is normal about 4 and shared within a group in part. The error is sigma(x)
// times what the covariance says, sigma from 1 to e^2 as x falls; an answer is wrong with log odds 4 - 2 x,
// of which the stated odds are half.
struct AnswerLaw {
  bool states_odds = true;
  double group_sd = 0.0;

  AnswerRow Draw(std::int64_t group, double shared, RandomStream& rng) const {
    AnswerRow row;
    row.group = group;
    row.features.fill(kNaN);
    const double x = 4.0 + group_sd * shared + std::sqrt(1.0 - group_sd * group_sd) * rng.Normal();
    row.features[kAgreeing] = x;
    const double log_odds = 4.0 - 2.0 * x;
    if (states_odds) row.features[kStated] = 0.5 * log_odds;
    row.is_wrong = rng.Uniform() < 1.0 / (1.0 + std::exp(-log_odds));
    double d2 = 0.0;
    for (int i = 0; i < 5; ++i) d2 += std::pow(rng.Normal(), 2);
    row.nees = row.is_wrong ? 1e4 * d2 : d2 * std::exp(std::max(0.0, 4.0 - x));
    row.max_error_deg = std::sqrt(row.nees);
    row.log_det = -30.0;
    return row;
  }

  std::vector<AnswerRow> DrawGroups(int num_groups, int per_group, RandomStream& rng) const {
    std::vector<AnswerRow> rows;
    for (int group = 0; group < num_groups; ++group) {
      const double shared = rng.Normal();
      for (int i = 0; i < per_group; ++i) rows.push_back(Draw(group, shared, rng));
    }
    return rows;
  }
};

bool Covers(const JudgedAnswer& answer) {
  return answer.row.nees <= answer.verdict.factor * ChiSquareQuantile(5, answer.level);
}

struct Kept {
  std::int64_t covered = 0, hard = 0, hard_covered = 0, n = 0, broken = 0, calibrations = 0;
  double accepted = 0.0, log_score = 0.0, stated_log_score = 0.0;
};

// Many calibrations, each followed by new answers. The accept rule breaks its promise where more than 2 % of
// all answers that could come are wrong and accepted, which 4,000 new ones tell.
Kept Calibrate(const AnswerLaw& law, int num_groups, int per_group, int repetitions, std::uint32_t purpose) {
  Kept kept;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    RandomStream rng({.seed = 1, .trial = static_cast<std::uint32_t>(repetition), .purpose = purpose});
    const ConformRule rule = FitConformRule(law.DrawGroups(num_groups, per_group, rng), {});
    const std::vector<JudgedAnswer> judged = JudgeAnswers(rule, law.DrawGroups(4000, 1, rng));
    double wrong = 0.0;
    for (const JudgedAnswer& answer : judged) {
      const bool is_hard = answer.row.features[kAgreeing] < 4.0 - 0.6745;  // a quarter
      kept.hard += is_hard;
      kept.hard_covered += is_hard && Covers(answer);
      kept.covered += Covers(answer);
      ++kept.n;
      wrong += answer.row.is_wrong && answer.verdict.is_accepted;
      kept.accepted += answer.verdict.is_accepted / (4000.0 * repetitions);
      kept.log_score +=
          LogScore(answer.verdict.failure_probability, answer.row.is_wrong) / (4000.0 * repetitions);
      const double stated = 1.0 / (1.0 + std::exp(-answer.row.features[kStated]));
      if (law.states_odds)
        kept.stated_log_score += LogScore(stated, answer.row.is_wrong) / (4000.0 * repetitions);
    }
    kept.broken += wrong / 4000.0 > 0.02;
    ++kept.calibrations;
  }
  return kept;
}

double Share(std::int64_t count, std::int64_t n) {
  return static_cast<double>(count) / static_cast<double>(n);
}

// Regions hold at every n, on average over calibrations and in the hardest quarter; the accept rule breaks
// its promise in at most 5 % of the calibrations (100 of them: a rate of .15 would be seen with probability
// .97).
TEST(FitConformRule, KeepsItsPromises) {
  for (const bool states_odds : {true, false}) {
    for (const int n : {30, 120, 400, 2000}) {
      const Kept kept = Calibrate({states_odds, 0.0}, n, 1, 100, 420);
      // The spread of a coverage over calibrations is at most sqrt(.95 * .05 / (n / 2)): .8 % in the mean of
      // 100.
      EXPECT_GE(Share(kept.covered, kept.n), 0.95 - 0.02) << n;
      EXPECT_LE(ExactBinomialInterval(kept.broken, 100, 0.99).lower, 0.05) << n;
      if (n < 400) continue;
      EXPECT_GE(Share(kept.hard_covered, kept.hard), 0.92) << n;
      EXPECT_GE(kept.accepted, 0.5) << n;
      if (states_odds) {
        EXPECT_LT(kept.log_score, kept.stated_log_score - 0.02) << n;
      }
    }
  }
}

// Groups that differ: the promise is for an answer of a new group.
TEST(FitConformRule, KeepsItsPromisesForNewGroups) {
  const Kept kept = Calibrate({true, 0.9}, 100, 20, 100, 421);
  EXPECT_GE(Share(kept.covered, kept.n), 0.95 - 0.02);
  EXPECT_LE(ExactBinomialInterval(kept.broken, 100, 0.99).lower, 0.05);
}

TEST(FitConformRule, IsFineUpToWhatItKnows) {
  RandomStream rng({.seed = 1, .purpose = 422});
  const AnswerLaw law;
  EXPECT_THROW(FitConformRule({}, {}), InputError);
  const ConformRule of_few = FitConformRule(law.DrawGroups(10, 1, rng), {});
  EXPECT_EQ(of_few.factors, std::vector<double>{kInfinity});
  EXPECT_FALSE(of_few.greatest_log_odds);
  const ConformRule of_many = FitConformRule(law.DrawGroups(2000, 1, rng), {});
  EXPECT_GE(of_many.factors.size(), 8U);
  EXPECT_LT(of_many.factors.front(), of_many.factors.back());
}

TEST(FitConformRule, OfAnswersWithoutAMotion) {
  RandomStream rng({.seed = 1, .purpose = 423});
  std::vector<AnswerRow> rows = AnswerLaw{}.DrawGroups(300, 1, rng);
  for (size_t i = 0; i < rows.size(); i += 30) {
    rows[i].features.fill(kNaN);
    rows[i].nees = rows[i].max_error_deg = rows[i].log_det = kInfinity;
    rows[i].is_wrong = true;
  }
  const ConformRule rule = FitConformRule(rows, {});
  EXPECT_EQ(JudgeAnswers(rule, rows).size(), rows.size());
}

// Every answer is judged once, by a rule of other groups: with as many groups as folds the hold-out of a
// group cannot change its own verdict.
TEST(CrossValidate, JudgesEachAnswerOnceByOthers) {
  RandomStream rng({.seed = 1, .purpose = 424});
  std::vector<AnswerRow> rows = AnswerLaw{}.DrawGroups(5, 30, rng);
  const std::vector<JudgedAnswer> before = CrossValidate(rows, {.level = 0.7});
  ASSERT_EQ(before.size(), rows.size());
  for (AnswerRow& row : rows) {
    if (row.group == 2) row.nees *= 100.0;
  }
  for (const JudgedAnswer& after : CrossValidate(rows, {.level = 0.7})) {
    if (after.row.group != 2) continue;
    const auto same = std::ranges::find_if(before, [&](const JudgedAnswer& b) {
      return b.row.group == 2 && b.row.features[kAgreeing] == after.row.features[kAgreeing];
    });
    ASSERT_NE(same, before.end());
    EXPECT_EQ(same->verdict.factor, after.verdict.factor);
  }
}

TEST(LookForShift, NoticesFewerMatchesAndSeldomAnythingElse) {
  int num_alarms = 0, num_noticed = 0;
  for (std::uint32_t repetition = 0; repetition < 100; ++repetition) {
    RandomStream rng({.seed = 1, .trial = repetition, .purpose = 425});
    const AnswerLaw law;
    const ConformRule rule = FitConformRule(law.DrawGroups(300, 1, rng), {});
    std::vector<AnswerRow> rows = law.DrawGroups(100, 1, rng);
    num_alarms += LookForShift(rule, rows).noticed_after.has_value();
    for (AnswerRow& row : rows) row.features[kAgreeing] -= 1.5;
    const ShiftFinding shift = LookForShift(rule, rows);
    num_noticed += shift.noticed_after.has_value() && shift.feature == "agreeing";
  }
  EXPECT_LE(ExactBinomialInterval(num_alarms, 100, 0.99).lower, 0.05) << num_alarms;
  EXPECT_GE(num_noticed, 95);
}

// Conditions come one after the other: hard ones first are no shift.
TEST(LookForShift, DoesNotMindTheOrderOfConditions) {
  int num_alarms = 0;
  for (std::uint32_t repetition = 0; repetition < 100; ++repetition) {
    RandomStream rng({.seed = 1, .trial = repetition, .purpose = 426});
    const AnswerLaw law;
    const ConformRule rule = FitConformRule(law.DrawGroups(300, 1, rng), {});
    std::vector<AnswerRow> rows = law.DrawGroups(200, 1, rng);
    std::ranges::sort(rows, {}, [](const AnswerRow& row) { return row.features[kAgreeing]; });
    num_alarms += LookForShift(rule, rows).noticed_after.has_value();
  }
  EXPECT_LE(ExactBinomialInterval(num_alarms, 100, 0.99).lower, 0.05) << num_alarms;
}

TEST(DescribeNeeds, NamesTheNumbers) {
  const std::string needs = DescribeNeeds({});
  EXPECT_NE(needs.find("Regions at 95 %: 19 answers"), std::string::npos) << needs;
  EXPECT_NE(needs.find("149 answers"), std::string::npos) << needs;
}

}  // namespace
}  // namespace rcme
