// Whether a choice keeps its guarantee, by simulation: settings that break the target are chosen in at most a
// share delta of the tunings.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <optional>

#include "experiments/tuning/choose_setting.h"
#include "stats/intervals.h"
#include "stats/random.h"
#include "tests/experiments/tuning/made_up_settings.h"

namespace rcme {
namespace {

// What a trial of one setting may end in.
struct Rates {
  double failure = 0.0, refusal = 0.0;
};

// The trials of many settings, independent of each other.
std::vector<SettingCount> Draw(const std::vector<Rates>& rates, std::int64_t n, RandomStream& rng) {
  std::vector<SettingCount> counts(rates.size());
  for (size_t s = 0; s < rates.size(); ++s) {
    std::int64_t failures = 0, refusals = 0;
    for (std::int64_t i = 0; i < n; ++i) {
      const double u = rng.Uniform();
      failures += u < rates[s].failure;
      refusals += u >= 1.0 - rates[s].refusal;
    }
    counts[s] = Of(n, failures, refusals);
  }
  return counts;
}

using Chooser = std::function<std::optional<size_t>(const std::vector<SettingCount>& explored,
                                                    const std::vector<SettingCount>& calibrated)>;

struct Violations {
  std::int64_t num = 0, num_choices = 0;
  Interval rate;  // so wide that one check in 100,000 is a false alarm
};

constexpr std::uint32_t kRepetitions = 3000;

Violations Repeat(const Tuning& tuning, const std::vector<Rates>& rates, std::int64_t explore,
                  std::int64_t calibrate, const Chooser& choose) {
  Violations violations;
  for (std::uint32_t r = 0; r < kRepetitions; ++r) {
    RandomStream rng({1, 0, r, 7});
    const std::vector<SettingCount> explored = Draw(rates, explore, rng);
    const std::optional<size_t> setting = choose(explored, Draw(rates, calibrate, rng));
    if (!setting) continue;
    ++violations.num_choices;
    violations.num +=
        rates[*setting].failure > tuning.at_most || rates[*setting].refusal > tuning.max_refusal;
  }
  violations.rate = ExactBinomialInterval(violations.num, kRepetitions, 1.0 - 2e-5);
  return violations;
}

Chooser AsItIs(const Tuning& tuning) {
  return [&](const auto& explored, const auto& calibrated) {
    return Choose(tuning, explored, calibrated).setting;
  };
}

// From few failures and many refusals to many failures and few refusals; the target of 10 % is crossed in
// the middle.
std::vector<Rates> Ladder(size_t n) {
  std::vector<Rates> rates(n);
  for (size_t s = 0; s < n; ++s) {
    const double x = static_cast<double>(s) / static_cast<double>(n - 1);
    rates[s] = {0.06 + 0.08 * x, 0.45 - 0.4 * x};
  }
  return rates;
}

TEST(Guarantee, IsKeptOnALadderOfSettings) {
  const Tuning tuning = TuningFor(TuneTarget::kFailure, 0.1);
  const Violations violations = Repeat(tuning, Ladder(40), 200, 800, AsItIs(tuning));
  EXPECT_LE(violations.rate.lower, tuning.delta) << violations.num;
  EXPECT_GT(violations.num_choices, kRepetitions / 2) << "nothing is chosen: the check has no power";
  RecordProperty("violations", static_cast<int>(violations.num));
}

// The worst case: every setting just above the target, so that every choice is a violation.
TEST(Guarantee, IsKeptWhereNoSettingIsGoodAndTheLevelIsNotWasted) {
  const Tuning tuning = TuningFor(TuneTarget::kFailure, 0.1);
  const Violations violations = Repeat(tuning, {50, {0.1001, 0.1}}, 200, 800, AsItIs(tuning));
  EXPECT_LE(violations.rate.lower, tuning.delta) << violations.num;
  EXPECT_GE(violations.rate.upper, 0.6 * tuning.delta) << violations.num;
  RecordProperty("violations", static_cast<int>(violations.num));
}

// Both limits are close, one or the other broken.
TEST(Guarantee, IsKeptForTwoLimitsAtOnce) {
  const Tuning tuning = TuningFor(TuneTarget::kFailure, 0.1, 0.3);
  std::vector<Rates> rates;
  for (int s = 0; s < 40; ++s) rates.push_back(s % 2 == 0 ? Rates{0.101, 0.25} : Rates{0.07, 0.301});
  const Violations violations = Repeat(tuning, rates, 200, 800, AsItIs(tuning));
  EXPECT_LE(violations.rate.lower, tuning.delta) << violations.num;
  RecordProperty("violations", static_cast<int>(violations.num));
}

// The same check finds a choice that is certified by the trials that proposed it, ...
TEST(Guarantee, AChoiceOnItsOwnTrialsIsFound) {
  const Tuning tuning = TuningFor(TuneTarget::kFailure, 0.1);
  const Violations violations =
      Repeat(tuning, {50, {0.1001, 0.1}}, 1, 800,
             [&](const auto&, const auto& counts) { return Choose(tuning, counts, counts).setting; });
  EXPECT_GT(violations.rate.lower, tuning.delta) << violations.num;
  RecordProperty("violations", static_cast<int>(violations.num));
}

// ... one without certification, ...
TEST(Guarantee, AChoiceWithoutCertificationIsFound) {
  const Tuning tuning = TuningFor(TuneTarget::kFailure, 0.1);
  const Violations violations = Repeat(tuning, Ladder(40), 200, 800, [&](const auto&, const auto& counts) {
    std::optional<size_t> best;
    for (size_t s = 0; s < counts.size(); ++s) {
      const bool seems_to_hold =
          static_cast<double>(counts[s].failures) <= tuning.at_most * static_cast<double>(counts[s].n);
      if (seems_to_hold && (!best || counts[s].refusals < counts[*best].refusals)) best = s;
    }
    return best;
  });
  EXPECT_GT(violations.rate.lower, tuning.delta) << violations.num;
  RecordProperty("violations", static_cast<int>(violations.num));
}

// ... and one that tests every setting at level delta, whatever became of those before.
TEST(Guarantee, AChoiceThatDoesNotStopAtTheFirstIsFound) {
  const Tuning tuning = TuningFor(TuneTarget::kFailure, 0.1);
  const Violations violations =
      Repeat(tuning, {50, {0.1001, 0.1}}, 1, 800, [&](const auto&, const auto& counts) {
        std::optional<size_t> any;
        for (size_t s = 0; s < counts.size(); ++s) {
          if (ExcessPValue(counts[s].Failure(), tuning.at_most) <= tuning.delta) any = s;
        }
        return any;
      });
  EXPECT_GT(violations.rate.lower, tuning.delta) << violations.num;
  RecordProperty("violations", static_cast<int>(violations.num));
}

// False refusals of good trials, whose number is random, in two conditions whose rates differ: in one almost
// all trials are good and few are refused, in the other few are good and most are refused. Settings are
// thresholds on the same number per trial, as levels of mu are.
struct Stratum {
  double good, spread;  // P(good); a good trial's score is `spread` times a uniform number
};
constexpr Stratum kStrata[] = {{0.95, 1.0}, {0.3, 3.0}};

// A setting s refuses scores above 0.9 + 0.06 s.
double Threshold(size_t s) { return 0.9 + 0.06 * static_cast<double>(s); }

double FalseRefusalRate(size_t s) {
  double good = 0.0, refused = 0.0;
  for (const auto& [p, spread] : kStrata) {
    good += p;
    refused += p * std::max(0.0, 1.0 - Threshold(s) / spread);
  }
  return refused / good;
}

std::vector<SettingCount> DrawStrata(size_t num_settings, int per_stratum, RandomStream& rng) {
  std::vector<SettingCount> counts(num_settings);
  for (const auto& [p, spread] : kStrata) {
    for (int i = 0; i < per_stratum; ++i) {
      const bool is_good = rng.Uniform() < p;
      const double score = spread * rng.Uniform();
      for (size_t s = 0; s < num_settings; ++s) {
        const bool is_refused = score > Threshold(s);
        counts[s] += {1, !is_good && !is_refused, is_refused, is_good, is_good && is_refused};
      }
    }
  }
  return counts;
}

TEST(Guarantee, IsKeptForFalseRefusalsOfUnlikeConditions) {
  constexpr size_t kNumSettings = 36;
  for (const double at_most : {0.05, 0.12}) {
    const Tuning tuning = TuningFor(TuneTarget::kFalseRefusal, at_most);
    ASSERT_LT(FalseRefusalRate(kNumSettings - 1), at_most);
    ASSERT_GT(FalseRefusalRate(0), at_most);
    std::int64_t num_violations = 0, num_choices = 0;
    for (std::uint32_t r = 0; r < kRepetitions; ++r) {
      RandomStream rng({1, 1, r, 7});
      const std::vector<SettingCount> explored = DrawStrata(kNumSettings, 50, rng);
      const Choice choice = Choose(tuning, explored, DrawStrata(kNumSettings, 150, rng));
      num_choices += choice.setting.has_value();
      num_violations += choice.setting && FalseRefusalRate(*choice.setting) > at_most;
    }
    EXPECT_LE(ExactBinomialInterval(num_violations, kRepetitions, 1.0 - 2e-5).lower, tuning.delta)
        << num_violations;
    EXPECT_GT(num_choices, kRepetitions / 2);
    RecordProperty("violations_at_" + std::to_string(at_most), static_cast<int>(num_violations));
  }
}

}  // namespace
}  // namespace rcme
