// The choice from made-up counts: no estimator takes part.
#include "experiments/tuning/choose_setting.h"

#include <gtest/gtest.h>

#include <chrono>

#include "stats/intervals.h"
#include "stats/random.h"
#include "tests/experiments/tuning/made_up_settings.h"

namespace rcme {
namespace {

using Path = std::vector<size_t>;

// False refusals of the good ones, and failures, of n trials.
SettingCount Quality(std::int64_t n, std::int64_t false_refusals, std::int64_t good, std::int64_t failures) {
  return {n, failures, false_refusals, good, false_refusals};
}

testing::AssertionResult Says(const std::string& text, const std::vector<std::string>& fragments) {
  for (const std::string& fragment : fragments) {
    if (text.find(fragment) == std::string::npos)
      return testing::AssertionFailure() << "'" << fragment << "' is not in: " << text;
  }
  return testing::AssertionSuccess();
}

// Failures against refusals: 1 is beaten by 3; 2, 4 and 5 tie in failures, 4 is more careful.
const std::vector<SettingCount> kExplored = {Of(100, 0, 60), Of(100, 3, 40), Of(100, 6, 10),
                                             Of(100, 2, 40), Of(100, 6, 11), Of(100, 6, 10)};

// Of limits on a stated probability: the strict one refuses 60 of 100 and none of its 40 fails, the middle
// one refuses 20 and 1 of 80 fails, without a limit 6 fail.
TEST(ChooseSetting, FailuresOfAcceptedTrialsAreOutOfThese) {
  const Tuning tuning = TuningFor(TuneTarget::kAcceptedFailure, 0.05);
  const std::vector<SettingCount> counts = {Of(1000, 0, 600), Of(1000, 10, 200), Of(1000, 60, 0)};
  EXPECT_EQ(TargetedCount(tuning, counts[1]).n, 800);
  EXPECT_EQ(TargetedCount(tuning, counts[1]).errors, 10);
  const Choice choice = Choose(tuning, counts, counts);
  EXPECT_EQ(choice.path, (Path{0, 1, 2}));
  EXPECT_EQ(choice.num_certified, 2u);
  EXPECT_EQ(choice.setting, 1u) << "the least refusal of those";
  EXPECT_EQ(Choose(TuningFor(TuneTarget::kAcceptedFailure, 0.05, 0.1), counts, counts).num_certified, 0u);
  // 40 of 1,000 trials fail: too many of the 500 that are accepted, not of all.
  EXPECT_EQ(DecideSetting(tuning, Of(1000, 40, 500)), Verdict::kDoesNotHold);
  EXPECT_NE(DecideSetting(TuningFor(TuneTarget::kFailure, 0.05), Of(1000, 40, 500)), Verdict::kDoesNotHold);
  const std::vector<SettingCount> none = {Of(100, 0, 100)};
  EXPECT_TRUE(Says(Choose(tuning, none, none).why, {"no trial is accepted", "that are not refused fail"}));
}

TEST(ChooseSetting, ThePathIsTheFrontInTheOrderOfSurety) {
  const Choice choice = Choose(TuningFor(TuneTarget::kFailure, 0.1), kExplored, kExplored);
  EXPECT_EQ(choice.path, (Path{0, 3, 4, 2, 5}));
}

// The order is fixed before the calibration: here it would be the other way round.
TEST(ChooseSetting, TheCalibrationHasNoSayInThePath) {
  std::vector<SettingCount> calibrated(kExplored.size(), Of(1000, 0, 0));
  calibrated[0] = Of(1000, 30, 500);
  calibrated[3] = Of(1000, 20, 400);
  EXPECT_EQ(Choose(TuningFor(TuneTarget::kFailure, 0.1), kExplored, calibrated).path, (Path{0, 3, 4, 2, 5}));
}

// No error of few trials is no proof: the lucky one of equals must not keep the careful one from being
// certified.
TEST(ChooseSetting, OfEqualsTheMoreCarefulIsTestedFirst) {
  const std::vector<SettingCount> explored = {Of(20, 0, 2), Of(20, 0, 9), Of(20, 0, 5)};
  const std::vector<SettingCount> calibrated = {Of(1000, 150, 100), Of(1000, 0, 450), Of(1000, 10, 250)};
  const Choice choice = Choose(TuningFor(TuneTarget::kFailure, 0.05), explored, calibrated);
  EXPECT_EQ(choice.path, (Path{1, 2, 0}));
  EXPECT_EQ(choice.setting, 2u);
}

TEST(ChooseSetting, TestingEndsAtTheFirstThatIsNotCertified) {
  std::vector<SettingCount> calibrated(kExplored.size(), Of(1000, 0, 0));
  calibrated[3] = Of(1000, 95, 400);  // P(Binomial(1000, 0.1) <= 95) = 0.32
  const Choice choice = Choose(TuningFor(TuneTarget::kFailure, 0.1), kExplored, calibrated);
  EXPECT_EQ(choice.num_certified, 1u);
  EXPECT_EQ(choice.setting, 0u);
  calibrated[0] = calibrated[3];
  const Choice none = Choose(TuningFor(TuneTarget::kFailure, 0.1), kExplored, calibrated);
  EXPECT_EQ(none.num_certified, 0u);
  EXPECT_FALSE(none.setting.has_value());
  EXPECT_FALSE(none.why.empty());
}

TEST(ChooseSetting, OfTheCertifiedTheLeastRefusalIsChosenTheFirstAtATie) {
  std::vector<SettingCount> calibrated(kExplored.size(), Of(1000, 0, 300));
  calibrated[3] = Of(1000, 5, 150);
  Choice choice = Choose(TuningFor(TuneTarget::kFailure, 0.1), kExplored, calibrated);
  EXPECT_EQ(choice.num_certified, 5u);
  EXPECT_EQ(choice.setting, 3u);
  calibrated[2] = calibrated[5] = Of(1000, 9, 150);
  EXPECT_EQ(Choose(TuningFor(TuneTarget::kFailure, 0.1), kExplored, calibrated).setting, 3u);
  calibrated[1] = Of(1000, 0, 0);  // not on the path
  EXPECT_EQ(Choose(TuningFor(TuneTarget::kFailure, 0.1), kExplored, calibrated).setting, 3u);
}

TEST(ChooseSetting, FalseRefusalsAreOfTheGoodTrialsAlone) {
  const Tuning tuning = TuningFor(TuneTarget::kFalseRefusal, 0.05);
  // 10 of 1000 trials are refused falsely, 1 %; of those that are good 1 % and 10 %.
  const std::vector<SettingCount> counts = {Quality(1000, 10, 1000, 50), Quality(1000, 10, 100, 0)};
  const Choice choice = Choose(tuning, counts, counts);
  EXPECT_EQ(choice.path, (Path{0, 1}));
  EXPECT_EQ(choice.num_certified, 1u);
  EXPECT_EQ(choice.setting, 0u);
}

TEST(ChooseSetting, FalseRefusalThenTheLeastFailure) {
  const Tuning tuning = TuningFor(TuneTarget::kFalseRefusal, 0.1);
  const std::vector<SettingCount> counts = {Quality(1000, 0, 800, 60), Quality(1000, 30, 800, 40),
                                            Quality(1000, 50, 800, 20)};
  EXPECT_EQ(Choose(tuning, counts, counts).setting, 2u);
  std::vector<SettingCount> calibrated = counts;
  calibrated[2].failures = 45;  // failures of the calibration decide
  EXPECT_EQ(Choose(tuning, counts, calibrated).setting, 1u);
}

TEST(ChooseSetting, RefusalsAreCertifiedToo) {
  const std::vector<SettingCount> counts = {Of(1000, 0, 600), Of(1000, 50, 200)};
  EXPECT_EQ(Choose(TuningFor(TuneTarget::kFailure, 0.1, 0.5), counts, counts).path, (Path{1, 0}));
  EXPECT_EQ(Choose(TuningFor(TuneTarget::kFailure, 0.1, 0.5), counts, counts).num_certified, 1u);
  // 480 of 1000 are below 50 %, but not surely enough: P(Binomial(1000, 0.5) <= 480) = 0.11.
  const std::vector<SettingCount> close = {Of(1000, 0, 600), Of(1000, 50, 480)};
  EXPECT_EQ(Choose(TuningFor(TuneTarget::kFailure, 0.1, 0.5), counts, close).num_certified, 0u);
  EXPECT_EQ(Choose(TuningFor(TuneTarget::kFailure, 0.1, 1.0), counts, counts).num_certified, 2u);
}

TEST(ChooseSetting, LeastRiskOfTheExplorationWithABoundFromTheCalibration) {
  Tuning tuning = TuningFor(TuneTarget::kRisk, 0.05);
  tuning.cost_of_failure = 10.0;
  tuning.cost_of_refusal = 2.0;
  tuning.delta = 0.1;
  const std::vector<SettingCount> explored = {Of(100, 10, 0), Of(100, 2, 30), Of(100, 0, 45)};
  const std::vector<SettingCount> calibrated = {Of(400, 0, 0), Of(400, 12, 100), Of(400, 0, 0)};
  const Choice choice = Choose(tuning, explored, calibrated);
  EXPECT_EQ(choice.setting, 1u);
  // Each of the two bounds is exceeded with probability 0.05: the upper ends of two-sided 90 % intervals.
  EXPECT_DOUBLE_EQ(choice.risk_bound, 10.0 * ExactBinomialInterval(12, 400, 0.9).upper +
                                          2.0 * ExactBinomialInterval(100, 400, 0.9).upper);
  EXPECT_DOUBLE_EQ(Risk(tuning, calibrated[1]), 10.0 * 0.03 + 2.0 * 0.25);
}

TEST(ChooseSetting, ATargetOutOfReachNamesTheNearest) {
  const std::vector<SettingCount> counts = {Of(1000, 300, 100), Of(1000, 200, 150), Of(1000, 250, 120)};
  const Choice choice = Choose(TuningFor(TuneTarget::kFailure, 0.05), counts, counts);
  EXPECT_TRUE(Says(choice.why, {"nearest is mu = 1:", "failure 20 % [17.6, 22.6] of 1000", "5 %",
                                "out of reach", "at most 5 % of the trials fail"}))
      << choice.why;
}

// 0.95^59 = 0.0485: 59 trials without an error certify 5 % at level 0.05, 58 do not (Wilks 1941).
TEST(ChooseSetting, TooFewTrialsSaysHowManyWouldDo) {
  const std::vector<SettingCount> counts = {Of(58, 0, 20)};
  const Choice choice = Choose(TuningFor(TuneTarget::kFailure, 0.05), counts, counts);
  EXPECT_TRUE(Says(choice.why,
                   {"too few trials", "59 certify 5 % with probability 0.9: calibrate: 407 instead of 400"}))
      << choice.why;
  // Of the same trials fewer are good: 59 good ones are in 2 * 59 of them.
  const std::vector<SettingCount> half = {Quality(58, 0, 29, 0)};
  const Choice of_half = Choose(TuningFor(TuneTarget::kFalseRefusal, 0.05), half, half);
  EXPECT_TRUE(Says(of_half.why, {"59 certify 5 %", "calibrate: 814 instead of 400"})) << of_half.why;
  const std::vector<SettingCount> above = {Of(20, 1, 0)};
  EXPECT_TRUE(Says(Choose(TuningFor(TuneTarget::kFailure, 0.05), above, above).why, {"not below 5 %"}));
}

// The promised number of trials is certified in nine of ten calibrations, by simulation; two thirds of it
// are not.
TEST(ChooseSetting, TheNumberOfTrialsThatWouldDoDoes) {
  const Tuning tuning = TuningFor(TuneTarget::kFailure, 0.05);
  const std::vector<SettingCount> counts = {Of(100, 2, 0)};
  const std::string why = Choose(tuning, counts, counts).why, before = "if that is the rate, ";
  ASSERT_TRUE(Says(why, {before}));
  const std::int64_t n = std::stoll(why.substr(why.find(before) + before.size()));
  const auto share_certified = [&](std::int64_t num_trials) {
    int num_certified = 0;
    for (std::uint32_t r = 0; r < 4000; ++r) {
      RandomStream rng({1, 0, r, 6});
      std::int64_t failures = 0;
      for (std::int64_t i = 0; i < num_trials; ++i) failures += rng.Uniform() < 0.02;
      num_certified += Choose(tuning, counts, {Of(num_trials, failures, 0)}).num_certified == 1;
    }
    return num_certified / 4000.0;
  };
  EXPECT_GT(share_certified(n), 0.88);
  EXPECT_LT(share_certified(2 * n / 3), 0.86);
}

TEST(ChooseSetting, RefusalsThatStandInTheWayAreNamed) {
  const std::vector<SettingCount> counts = {Of(1000, 0, 900), Of(1000, 200, 300)};
  const Choice choice = Choose(TuningFor(TuneTarget::kFailure, 0.05, 0.2), counts, counts);
  EXPECT_TRUE(Says(choice.why, {"nearest is mu = 1", "failure 20 %", "5 % is out of reach", "refusal 30 %",
                                "20 % is out of reach", "at most 20 % are refused"}))
      << choice.why;
}

// A calibration that certifies the nearest, but not the one tested before it.
TEST(ChooseSetting, AnotherTestedBeforeStandsInTheWay) {
  const std::vector<SettingCount> explored = {Of(100, 2, 10), Of(100, 1, 45)};
  const std::vector<SettingCount> calibrated = {Of(1000, 100, 10), Of(1000, 0, 450)};
  const Choice choice = Choose(TuningFor(TuneTarget::kFailure, 0.05, 0.5), explored, calibrated);
  EXPECT_EQ(choice.path, (Path{0, 1}));
  EXPECT_TRUE(Says(choice.why, {"mu = 1", "it could be certified", "explore more than 100"})) << choice.why;
}

TEST(ChooseSetting, TooFewTrialsWhateverTheyShow) {
  Tuning tuning = TuningFor(TuneTarget::kFailure, 0.05);
  tuning.calibrate = 1;
  EXPECT_EQ(WhyTooFewTrials(tuning, 59), "");
  EXPECT_TRUE(Says(WhyTooFewTrials(tuning, 58), {"calibrate: 1 in each of 58", "5 %", "delta 0.05",
                                                 "59 trials would do", "calibrate: 2"}));
  tuning.max_refusal = 0.01;  // 299 trials: 0.99^299 = 0.0495
  EXPECT_EQ(WhyTooFewTrials(tuning, 299), "");
  tuning.calibrate = 29;
  EXPECT_TRUE(Says(WhyTooFewTrials(tuning, 10), {"29 in each of 10", "1 %", "299 trials", "calibrate: 30"}));
  tuning.calibrate = 30;
  EXPECT_EQ(WhyTooFewTrials(tuning, 10), "");
  tuning.target = TuneTarget::kFalseRefusal;  // which max_refusal does not limit
  EXPECT_EQ(WhyTooFewTrials(tuning, 2), "");
  tuning.target = TuneTarget::kRisk;
  tuning.calibrate = 1;
  EXPECT_EQ(WhyTooFewTrials(tuning, 1), "");
}

// Whatever is asked, as many trials as are said to be enough are certified if none errs, and one fewer are
// not.
TEST(ChooseSetting, EnoughTrialsAreEnoughAndNoMore) {
  for (const double at_most : {0.001, 0.01, 0.05, 0.1, 0.5, 0.75, 0.9, 0.95, 0.999}) {
    for (const double delta : {0.001, 0.01, 0.05, 0.1, 0.25, 0.5}) {
      Tuning tuning = TuningFor(TuneTarget::kFailure, at_most);
      tuning.delta = delta;
      tuning.calibrate = 1;
      size_t n = 1;
      while (!WhyTooFewTrials(tuning, n).empty()) ++n;
      const auto is_certified = [&](size_t num_trials) {
        const std::vector<SettingCount> counts = {Of(static_cast<std::int64_t>(num_trials), 0, 0)};
        return Choose(tuning, counts, counts).num_certified == 1;
      };
      EXPECT_TRUE(is_certified(n)) << at_most << " at " << delta;
      EXPECT_FALSE(n > 1 && is_certified(n - 1)) << at_most << " at " << delta;
    }
  }
}

TEST(ChooseSetting, NoGoodTrialCertifiesNothing) {
  const std::vector<SettingCount> counts = {Quality(1000, 0, 0, 0)};
  const Choice choice = Choose(TuningFor(TuneTarget::kFalseRefusal, 0.05), counts, counts);
  EXPECT_FALSE(choice.setting.has_value());
  EXPECT_TRUE(Says(choice.why, {"nearest is mu = 0: false refusal: no trial would be good"})) << choice.why;
}

TEST(ChooseSetting, OneTrialAndOneSetting) {
  Tuning tuning = TuningFor(TuneTarget::kFailure, 0.96);
  const std::vector<SettingCount> one = {Of(1, 0, 0)}, failed = {Of(1, 1, 0)};
  EXPECT_EQ(Choose(tuning, one, one).setting, 0u);  // 1 - 0.96 < delta
  EXPECT_FALSE(Choose(tuning, one, failed).setting.has_value());
  tuning.at_most = 0.9;
  EXPECT_FALSE(Choose(tuning, one, one).setting.has_value());
}

TEST(ChooseSetting, ManyEqualSettingsAreChosenFromInAMoment) {
  const std::vector<SettingCount> equal(kMaxTunedSettings, Of(1000, 10, 100));
  const auto start = std::chrono::steady_clock::now();
  const Choice choice = Choose(TuningFor(TuneTarget::kFailure, 0.1, 0.5), equal, equal);
  EXPECT_EQ(choice.path.size(), kMaxTunedSettings);
  EXPECT_EQ(choice.num_certified, kMaxTunedSettings);
  EXPECT_EQ(choice.setting, 0u);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

}  // namespace
}  // namespace rcme
