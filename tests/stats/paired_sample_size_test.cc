#include "stats/paired_sample_size.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "stats/paired.h"
#include "stats/random.h"

namespace rcme {
namespace {

// By hand, with z = 1.959964 and 0.841621: (1.959964 sqrt(s) + 0.841621 sqrt(s - d^2))^2 / d^2.
TEST(TrialsToTellApart, KnownAnswers) {
  EXPECT_EQ(TrialsToTellApart(0.25, 0.10), 120);  // s 0.35, d 0.15: 119.7
  EXPECT_EQ(TrialsToTellApart(0.10, 0.25), 120) << "whichever is first";
  EXPECT_EQ(TrialsToTellApart(0.02, 0.01), 2353);            // s 0.03, d 0.01: 2352.3
  EXPECT_EQ(TrialsToTellApart(0.25, 0.10, 0.05, 0.9), 160);  // z 1.281552: 159.3
}

TEST(TrialsToTellApart, EqualSharesAreNeverToldApart) {
  EXPECT_EQ(TrialsToTellApart(0.1, 0.1), std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(TrialsToTellApart(0.0, 0.0), std::numeric_limits<std::int64_t>::max());
}

TEST(TrialsToTellApart, SharesThatAreNoneAreRefused) {
  EXPECT_THROW(TrialsToTellApart(-0.1, 0.2), std::invalid_argument);
  EXPECT_THROW(TrialsToTellApart(0.6, 0.5), std::invalid_argument);
  EXPECT_THROW(TrialsToTellApart(std::nan(""), 0.5), std::invalid_argument);
}

// The promise: with so many trials McNemar's exact test, which is somewhat more cautious than the normal one
// of the formula, finds the difference in about 80 % of 2,000 repetitions. Their standard error is 0.9
// points.
TEST(TrialsToTellApart, HaveThePower) {
  RandomStream rng({1, 0, 0, 77});
  const double first_only = 0.06, second_only = 0.02;
  const std::int64_t n = TrialsToTellApart(first_only, second_only);
  int num_found = 0;
  for (int repetition = 0; repetition < 2000; ++repetition) {
    PairedCounts counts;
    for (std::int64_t i = 0; i < n; ++i) {
      const double u = rng.Uniform();
      counts.Add(u < first_only, u >= first_only && u < first_only + second_only);
    }
    num_found += McNemarExactPValue(counts) <= 0.05;
  }
  EXPECT_GE(num_found, 1450);
  EXPECT_LE(num_found, 1660);
}

}  // namespace
}  // namespace rcme
