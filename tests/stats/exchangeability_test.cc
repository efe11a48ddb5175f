#include "stats/exchangeability.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "stats/intervals.h"
#include "stats/random.h"

namespace rcme {
namespace {

struct Found {
  std::int64_t alarms = 0, added = 0;  // alarms, and observations added up to them
};

// 400 tests of a reference of 100 and at most 200 new observations of three features, of which the second
// is changed by `change`.
template <typename Change>
Found CountAlarms(const Change& change) {
  Found found;
  for (std::uint32_t repetition = 0; repetition < 400; ++repetition) {
    RandomStream rng({.seed = 1, .trial = repetition, .purpose = 414});
    std::vector<double> reference(300);
    for (double& x : reference) x = rng.Normal();
    ExchangeabilityTest test(reference, 3, RandomStream({.seed = 2, .trial = repetition, .purpose = 414}));
    for (int i = 0; i < 200 && test.PValue() > 0.05; ++i) {
      const std::vector<double> next = {rng.Normal(), change(rng.Normal()), rng.Normal()};
      test.Add(next);
    }
    found.alarms += test.PValue() <= 0.05;
    if (test.PValue() <= 0.05) found.added += static_cast<std::int64_t>(test.n());
  }
  return found;
}

// At most 5 % at any of 200 looks: a rate of .10 would be seen with probability .97.
TEST(Exchangeability, RarelyCallsWhatIsAlikeAShift) {
  const Found found = CountAlarms([](double x) { return x; });
  EXPECT_LE(ExactBinomialInterval(found.alarms, 400, 0.99).lower, 0.05) << found.alarms;
}

TEST(Exchangeability, NoticesAShiftUpAndDown) {
  for (const double shift : {-2.0, 2.0}) {
    const Found found = CountAlarms([&](double x) { return x + shift; });
    EXPECT_GE(found.alarms, 396);
    EXPECT_LE(static_cast<double>(found.added) / static_cast<double>(found.alarms), 40.0);
  }
}

TEST(Exchangeability, NoticesAWiderSpread) {
  EXPECT_GE(CountAlarms([](double x) { return 3.0 * x; }).alarms, 380);
}

// Each feature is tested at a k-th of the level: copies of a feature add nothing but their number.
TEST(Exchangeability, EveryFeatureHasItsPartOfTheLevel) {
  RandomStream rng({.seed = 5, .purpose = 414});
  std::vector<double> reference(1000), tripled;
  for (double& x : reference) {
    x = rng.Normal();
    tripled.insert(tripled.end(), 3, x);
  }
  ExchangeabilityTest one(reference, 1, rng), three(tripled, 3, rng);
  for (int i = 0; i < 30; ++i) {
    const std::vector<double> next(3, 1.2 + 0.001 * i);  // in the upper part, where ties hardly matter
    one.Add({next.data(), 1});
    three.Add(next);
  }
  EXPECT_LT(one.PValue(), 0.01);
  EXPECT_NEAR(three.PValue() / one.PValue(), 3.0, 0.5);
}

// Ties are broken at random: features that are always equal say nothing.
TEST(Exchangeability, HoldsWithTies) {
  std::int64_t alarms = 0;
  for (std::uint32_t repetition = 0; repetition < 400; ++repetition) {
    ExchangeabilityTest test(std::vector<double>(50, 1.0), 1,
                             RandomStream({.seed = 3, .trial = repetition, .purpose = 414}));
    for (int i = 0; i < 100; ++i) test.Add(std::vector<double>{1.0});
    alarms += test.PValue() <= 0.05;
  }
  EXPECT_LE(ExactBinomialInterval(alarms, 400, 0.99).lower, 0.05) << alarms;
}

TEST(Exchangeability, NamesTheFeatureThatDiffers) {
  RandomStream rng({.seed = 4, .purpose = 414});
  std::vector<double> reference(300);
  for (double& x : reference) x = rng.Normal();
  ExchangeabilityTest test(reference, 3, rng);
  for (int i = 0; i < 30; ++i) test.Add(std::vector<double>{rng.Normal(), rng.Normal(), rng.Normal() - 3.0});
  EXPECT_EQ(test.StrongestFeature(), 2U);
}

TEST(Exchangeability, RefusesWhatIsNone) {
  const RandomStream rng({.seed = 1});
  EXPECT_THROW(ExchangeabilityTest({}, 0, rng), std::invalid_argument);
  EXPECT_THROW(ExchangeabilityTest(std::vector<double>{1.0}, 2, rng), std::invalid_argument);
  ExchangeabilityTest test({}, 2, rng);
  EXPECT_THROW(test.Add(std::vector<double>{1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace rcme
