// How often the interval of stats/level_crossing.h holds the crossing, and how wide it is, on known curves:
// the study behind results/statistics. Two thirds of the trials are for the interval, as in `rcme solve`.
//   rcme_crossing_coverage [searches per row, default 400]
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>
#include <tuple>
#include <vector>

#include "stats/intervals.h"
#include "stats/level_crossing.h"
#include "stats/random.h"
#include "tests/test_support/known_crossings.h"

int main(int argc, char** argv) {
  using namespace rcme;
  const int num_searches = argc > 1 ? std::atoi(argv[1]) : 400;
  fmt::print("curve,rate,trials,n,interval,covered,lower,upper,median_width,median_error\n");
  std::uint32_t row = 0;
  for (const double rate : {0.01, 0.1, 0.5}) {
    for (const std::int64_t num_trials : {1'000, 10'000, 100'000}) {
      for (const KnownCrossing& curve : KnownCrossings(rate)) {
        const CrossingCoverage c = MeasureCrossingCoverage(curve, rate, num_trials, num_searches, row++);
        for (const auto& [kind, num_covered, width] :
             {std::tuple("monotone", c.num_covered, c.median_width),
              std::tuple("logistic", c.num_covered_logistic, c.median_width_logistic)}) {
          const Interval interval = ExactBinomialInterval(num_covered, num_searches);
          fmt::print("{},{},{},{},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f}\n", curve.name, rate, num_trials,
                     num_searches, kind, static_cast<double>(num_covered) / num_searches, interval.lower,
                     interval.upper, width, c.median_error);
        }
      }
    }
  }
}
