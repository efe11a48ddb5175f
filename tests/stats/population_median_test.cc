#include "stats/population_median.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "stats/random.h"

namespace rcme {
namespace {

// Numbers of 30 draws whose logarithms differ by as much between draws as within: the interval of the
// population covers the median 1 in 400 samples as often as it says, that of independent numbers does not.
TEST(PopulationMedianTest, CoversWhereDrawsDiffer) {
  constexpr int kNumSamples = 400;
  int num_covered = 0, num_covered_as_independent = 0;
  for (std::uint32_t sample = 0; sample < kNumSamples; ++sample) {
    RandomStream rng({7, sample, 0, 0});
    std::vector<StreamMedian> draws(30);
    for (StreamMedian& draw : draws) {
      const double center = rng.Normal();
      for (int i = 0; i < 40; ++i) draw.Add(std::exp(center + rng.Normal()));
    }
    std::vector<const StreamMedian*> pointers;
    for (const StreamMedian& draw : draws) pointers.push_back(&draw);
    const PopulationMedian median = MeasurePopulationMedian(pointers);
    num_covered += median.interval.Contains(1.0);
    num_covered_as_independent += median.of_these_conditions.Contains(1.0);
  }
  // More than 367 with probability .996 at a coverage of .95, .10 at .90, .006 at .88.
  EXPECT_GE(num_covered, 368);
  EXPECT_LT(num_covered_as_independent, 250);
}

}  // namespace
}  // namespace rcme
