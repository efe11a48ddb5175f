#include "experiments/gate/gate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "experiments/gate/gate_output.h"
#include "stats/constants.h"
#include "stats/random.h"
#include "tests/test_support/coverage_count.h"
#include "tests/test_support/expect_input_error.h"

namespace rcme {
namespace {

constexpr std::uint32_t kConditions = 3;

// What becomes of a trial; the rest of a record follows.
TrialRecord MakeGateRecord(bool fails, bool refuses = false) {
  TrialRecord record;
  record.status = refuses ? MotionStatus::kNoCandidate : MotionStatus::kOk;
  record.rotation_error_deg = record.direction_error_deg = refuses ? std::nan("") : fails ? 90.0 : 1.0;
  record.nees = refuses ? std::nan("") : fails ? 1e3 : 5.0;
  record.failure_probability = refuses ? std::nan("") : 0.1;
  record.seconds = 0.01;
  return record;
}

using MakeRecords = std::function<std::vector<TrialRecord>(std::uint32_t condition, std::uint32_t trial)>;

ReadableRun MakeRun(const MakeRecords& make, std::uint32_t num_rounds, const std::string& study_yaml = "") {
  ReadableRun run;
  run.description.study_yaml = study_yaml;
  run.description.conditions.resize(kConditions);
  run.description.estimators.resize(make(0, 0).size());
  run.for_each_trial = [=](const VisitTrial& visit) {
    for (std::uint32_t c = 0; c < kConditions; ++c) {
      for (std::uint32_t t = 0; t < num_rounds; ++t) {
        ProblemRecord problem;
        problem.condition = c;
        problem.trial = t;
        visit(problem, make(c, t));
      }
    }
  };
  return run;
}

std::vector<GateTest> FailureTest(double margin = 0.005) {
  std::vector<GateTest> tests = MakeGateTests({"failure"}, {});
  tests.front().margin = margin;
  return tests;
}

GateLook Look(const ReadableRun& run, const std::vector<GateTest>& tests, std::int64_t max_rounds) {
  return LookUntilDecided(run, tests, max_rounds, [](std::int64_t) { return true; });
}

TEST(GateQuantity, DifferencesAndMargins) {
  const GateQuantity& failure = GateQuantities().front();
  EXPECT_EQ(failure.Difference(1.0, 0.0), 1.0);
  const GateQuantity error = MakeGateTests({"error"}, {}).front().quantity;
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(error.Difference(1.1, 1.0), std::log(1.1), 1e-12);
  EXPECT_EQ(error.Difference(infinity, 1.0), 1.0);
  EXPECT_EQ(error.Difference(0.0, 1.0), -1.0);
  EXPECT_EQ(error.Difference(infinity, infinity), 0.0);
  EXPECT_NEAR(error.FromDifference(error.ToDifference(0.05)), 0.05, 1e-12);
  EXPECT_EQ(MakeGateTests({"time", "failure"}, {"time=0.2"}).back().margin, 0.2);
  const auto with_margin = [](const std::string& margin) { MakeGateTests({"failure"}, {margin}); };
  EXPECT_TRUE(ThrowsInputError([&] { with_margin("faliure=0.1"); }, {"did you mean 'failure'?"}));
  EXPECT_TRUE(ThrowsInputError([&] { with_margin("failure=1.5"); }, {"between 0 and 1"}));
  EXPECT_TRUE(ThrowsInputError([&] { with_margin("time=0.1"); }, {"is not judged"}));
}

// Regions twice as large lack the truth less often: beside miscoverage stands what that cost. ln det of five
// axes twice as long is 10 ln 2 greater; pairs with a singular covariance say nothing of it.
TEST(Gate, MiscoverageIsNotShownWithoutTheSizeOfTheRegions) {
  const auto wider = [](std::uint32_t, std::uint32_t t) {
    std::vector<TrialRecord> records(2, MakeGateRecord(false));
    records[0].density.log_det_cov = -60.0 + t % 7;
    records[1].density.log_det_cov =
        t % 5 == 0 ? kNaN : records[0].density.log_det_cov + 10.0 * std::log(2.0);
    return records;
  };
  GateReport report;
  report.new_label = "new", report.old_label = "old";
  report.num_conditions = kConditions;
  report.look = TakeGateLook(MakeRun(wider, 50), MakeGateTests({"failure", "miscoverage"}, {}), 50);
  ASSERT_EQ(report.look.rows.size(), 2u);
  EXPECT_TRUE(std::isnan(report.look.rows[0].size_ratio));
  EXPECT_NEAR(report.look.rows[1].size_ratio, 2.0, 1e-12);
  EXPECT_NE(GateAsText(report).find("2 times as large"), std::string::npos) << GateAsText(report);
  EXPECT_NE(RenderResult(MakeGateResult(report), "csv").find("size_ratio"), std::string::npos);
  for (GateRow& row : report.look.rows) row.size_ratio = kNaN;
  EXPECT_EQ(GateAsText(report).find("regions"), std::string::npos);
}

// Without a discordant pair a stake f of the gambler's grows by 1 + f (0.5 / 0.4975 - 1) a trial.
TEST(Gate, EqualAnswersAreNotWorseOnceTheCapitalSaysSo) {
  const auto equal = [](std::uint32_t, std::uint32_t t) {
    return std::vector<TrialRecord>(2, MakeGateRecord(t % 10 == 0, t % 10 == 1));
  };
  const ReadableRun run = MakeRun(equal, 2000);
  const GateLook look = Look(run, MakeGateTests(GateQuantityNames(), {}), 2000);
  EXPECT_EQ(look.verdict, GateVerdict::kNotWorse);
  const GateRow& failure = look.rows.front();
  EXPECT_EQ(failure.difference, 0.0);
  EXPECT_LE(failure.interval.upper, 0.005);
  EXPECT_NEAR(failure.of_new, 0.1, 0.01);
  const std::int64_t n = look.num_rounds * kConditions;
  EXPECT_GT(n, 600) << "0.95 log(1 + 0.95 x 0.005) stakes cannot earn log 20 sooner";
  EXPECT_LT(n, 2000);
  double before = 1.0;
  for (const std::int64_t rounds : {20, 60, 200, 600, 2000}) {
    const GateRow row = TakeGateLook(run, FailureTest(), rounds).rows.front();
    EXPECT_LT(row.p_not_worse, before) << "more trials say more";
    EXPECT_EQ(row.p_worse, 1.0);
    before = row.p_not_worse;
  }
}

TEST(Gate, IsMonotoneInTheMarginAndTheNumberOfFailures) {
  double p_worse_before = 0.0, p_not_worse_before = 1.0;
  const auto five_percent = [](std::uint32_t, std::uint32_t t) {
    return std::vector{MakeGateRecord(false), MakeGateRecord(t % 20 == 0)};
  };
  for (const double margin : {0.002, 0.01, 0.03, 0.049, 0.08, 0.2}) {
    const GateRow row = TakeGateLook(MakeRun(five_percent, 200), FailureTest(margin), 200).rows.front();
    EXPECT_GE(row.p_worse, p_worse_before);
    EXPECT_LE(row.p_not_worse, p_not_worse_before);
    p_worse_before = row.p_worse;
    p_not_worse_before = row.p_not_worse;
  }
  double difference_before = -1.0;
  for (const std::uint32_t every : {100U, 50U, 20U, 5U, 1U}) {
    const auto make = [every](std::uint32_t, std::uint32_t t) {
      return std::vector{MakeGateRecord(false), MakeGateRecord(t % every == 0)};
    };
    const GateRow row = TakeGateLook(MakeRun(make, 200), FailureTest(), 200).rows.front();
    EXPECT_GT(row.difference, difference_before);
    difference_before = row.difference;
  }
  const auto worst = [](std::uint32_t, std::uint32_t) {
    return std::vector{MakeGateRecord(false), MakeGateRecord(true)};
  };
  EXPECT_EQ(Look(MakeRun(worst, 67), FailureTest(), 67).verdict, GateVerdict::kWorse);
}

TEST(Gate, IsUndecidedWhereTheTrialsEndOrTheTimeDoes) {
  const auto equal = [](std::uint32_t, std::uint32_t) { return std::vector(2, MakeGateRecord(false)); };
  const ReadableRun run = MakeRun(equal, 50);
  const GateLook look = Look(run, FailureTest(), 50);
  EXPECT_EQ(look.verdict, GateVerdict::kUndecided);
  EXPECT_EQ(look.num_rounds, 50);
  const GateLook no_time = LookUntilDecided(run, FailureTest(), 50, [](std::int64_t) { return false; });
  EXPECT_EQ(no_time.verdict, GateVerdict::kUndecided);
  ASSERT_EQ(no_time.rows.size(), 1U);
  EXPECT_EQ(no_time.rows.front().n, 0);
  EXPECT_EQ(no_time.num_rounds, 0);
}

TEST(Gate, ALimitNeedsNoOldVersion) {
  const auto one_percent = [](std::uint32_t, std::uint32_t t) {
    return std::vector{MakeGateRecord(t % 100 == 7)};
  };
  std::vector<GateTest> tests = FailureTest(0.02);
  tests.front().is_limit = true;
  EXPECT_EQ(Look(MakeRun(one_percent, 3000), tests, 3000).verdict, GateVerdict::kNotWorse);
  tests.front().margin = 0.004;
  EXPECT_EQ(Look(MakeRun(one_percent, 3000), tests, 3000).verdict, GateVerdict::kWorse);
}

// A new version that refuses every problem has no region, error or probability, and is worse all the same.
TEST(Gate, RefusingEverythingIsWorse) {
  const auto make = [](std::uint32_t, std::uint32_t) {
    return std::vector{MakeGateRecord(false), MakeGateRecord(false, true)};
  };
  GateReport report;
  report.new_label = "new", report.old_label = "old";
  report.num_conditions = kConditions;
  report.look = Look(MakeRun(make, 100), MakeGateTests(GateQuantityNames(), {}), 100);
  EXPECT_EQ(report.look.verdict, GateVerdict::kWorse);
  for (const GateRow& row : report.look.rows) {
    const std::string& name = row.test.quantity.name;
    EXPECT_EQ(row.verdict == GateVerdict::kWorse, name == "refusal") << name;
    EXPECT_EQ(row.verdict == GateVerdict::kNotMeasured,
              name == "miscoverage" || name == "probability" || name == "error")
        << name;
  }
  EXPECT_NE(GateSentence(report).find("not measured, because no trial has it of both versions: miscoverage, "
                                      "probability, error"),
            std::string::npos)
      << GateSentence(report);
  EXPECT_NE(GateAsJUnit(report).find("failures=\"1\""), std::string::npos);
  EXPECT_NE(GateAsJUnit(report).find("skipped=\"3\""), std::string::npos);
  EXPECT_NE(GateAsJson(report).find("\"not measured\""), std::string::npos);
}

TEST(Gate, WhatOnlyOneVersionStatesCannotBeJudged) {
  const auto make = [](std::uint32_t, std::uint32_t) {
    std::vector<TrialRecord> records(2, MakeGateRecord(false));
    records.back().failure_probability = std::nan("");
    return records;
  };
  const ReadableRun run = MakeRun(make, 100);
  const std::vector<GateTest> probability = MakeGateTests({"probability"}, {});
  EXPECT_TRUE(ThrowsInputError([&] { Look(run, probability, 100); }, {"no trial has probability", "--of"}));
  EXPECT_EQ(TakeGateLook(run, probability, 50).rows.front().verdict, GateVerdict::kNotMeasured);
  const auto neither = [](std::uint32_t, std::uint32_t) {
    std::vector<TrialRecord> records(2, MakeGateRecord(false));
    for (TrialRecord& record : records) record.failure_probability = std::nan("");
    return records;
  };
  const GateLook look = Look(MakeRun(neither, 2000), MakeGateTests({"failure", "probability"}, {}), 2000);
  EXPECT_EQ(look.rows.back().verdict, GateVerdict::kNotMeasured);
  EXPECT_EQ(look.verdict, GateVerdict::kNotWorse) << "of what is measured";
}

TEST(Gate, ChangedTrialsAreListedWithTheWorseFirst) {
  const auto make = [](std::uint32_t c, std::uint32_t t) {
    return std::vector{MakeGateRecord(c == 0 && t == 1), MakeGateRecord(c == 2 && t == 4, c == 1 && t == 3)};
  };
  const std::vector<ChangedTrial> changed = FindChangedTrials(MakeRun(make, 10), 10);
  ASSERT_EQ(changed.size(), 3U);
  EXPECT_EQ(changed[0].condition, 1U);
  EXPECT_EQ(changed[0].of_new, StatusName(MotionStatus::kNoCandidate));
  EXPECT_EQ(changed[1].condition, 2U);
  EXPECT_TRUE(changed[1].is_for_worse);
  EXPECT_FALSE(changed[2].is_for_worse);
  EXPECT_EQ(changed[2].of_old, "failure");
  EXPECT_EQ(FindChangedTrials(MakeRun(make, 10), 4).size(), 2U) << "those beyond the look are left out";
}

// A round of conditions that share scenes is one observation, however many conditions there are.
TEST(Gate, TrialsThatShareASceneCountOnce) {
  const auto make = [](std::uint32_t, std::uint32_t t) {
    return std::vector{MakeGateRecord(false), MakeGateRecord(t % 4 == 0)};
  };
  const GateRow apart = TakeGateLook(MakeRun(make, 100), FailureTest(), 100).rows.front();
  const GateRow common =
      TakeGateLook(MakeRun(make, 100, "name: s\ncommon_scenes: true\n"), FailureTest(), 100).rows.front();
  EXPECT_EQ(apart.n, 100 * kConditions);
  EXPECT_EQ(common.n, 100);
  EXPECT_EQ(apart.difference, common.difference);
  EXPECT_GT(common.p_worse, apart.p_worse);
  ReadableRun repeated = MakeRun(make, 100);
  repeated.description.repeats_per_scene = 4;
  EXPECT_EQ(TakeGateLook(repeated, FailureTest(), 100).rows.front().n, 25 * kConditions);
}

// Failures of both versions where the conditions differ: the old one fails with probability 0.02, 0.1, 0.3,
// and the new one besides with the probability `more`, mostly in the last condition.
struct GateCounts {
  CoverageCount worse, not_worse;
};
GateCounts CountVerdicts(double more, int num_runs, std::uint32_t max_rounds) {
  constexpr double kFails[kConditions] = {0.02, 0.1, 0.3};
  const double lost[kConditions] = {0.0, 0.6 * more, 2.4 * more};  // mean: more
  GateCounts counts;
  for (int r = 0; r < num_runs; ++r) {
    const auto make = [&, r](std::uint32_t c, std::uint32_t t) {
      RandomStream rng({1, static_cast<std::uint64_t>(r), t, c});
      const double u = rng.Uniform();
      const bool old_fails = u < kFails[c];
      return std::vector{MakeGateRecord(old_fails), MakeGateRecord(old_fails || u > 1.0 - lost[c])};
    };
    const GateVerdict verdict = Look(MakeRun(make, max_rounds), FailureTest(0.02), max_rounds).verdict;
    counts.worse.Add(verdict == GateVerdict::kWorse);
    counts.not_worse.Add(verdict == GateVerdict::kNotWorse);
  }
  return counts;
}

// False alarms of this test itself: at most 1e-4 where the gate keeps its 5 %. At the very margin both
// verdicts are wrong with probability at most 5 %; a change of three margins is found with power 0.95 or more
// and no change is passed with it, here with rates of at least 0.95 at confidence 0.9999.
TEST(Gate, KeepsItsLevelAtTheMarginAndFindsWhatIsBeyond) {
  const GateCounts none = CountVerdicts(0.0, 200, 2000), at_margin = CountVerdicts(0.02, 200, 1000),
                   beyond = CountVerdicts(0.06, 200, 2000);
  EXPECT_LE(none.worse.interval().lower, 0.05) << none.worse;
  EXPECT_LE(at_margin.worse.interval().lower, 0.05) << at_margin.worse;
  EXPECT_LE(at_margin.not_worse.interval().lower, 0.05) << at_margin.not_worse;
  EXPECT_GE(none.not_worse.interval().lower, 0.95 - 0.02) << none.not_worse;
  EXPECT_GE(beyond.worse.interval().lower, 0.95 - 0.02) << beyond.worse;
}

}  // namespace
}  // namespace rcme
