// The table of the paper (table::real-data-test), as counts. The paper prints percentages with two decimals;
// each of them corresponds to exactly one number of pairs.
#pragma once

#include <string>
#include <vector>

#include "stats/intervals.h"

namespace rcme {

// The rate of one method on one dataset, or on all indoor or outdoor datasets.
struct PrintedRate {
  std::string row, method, quantity;  // method: RCME, pRCME, Standard; quantity: detect_fail, failure
  int count = 0, n = 0;
  Interval interval;  // exact binomial, as if pairs were independent
};
// Returns the rates of every dataset, then of "indoor" and "outdoor".
std::vector<PrintedRate> PrintedRates();

// The failures of two methods on the same pairs. The paper does not print on how many pairs both fail, so
// these are McNemar's exact p-values for as many common failures as possible and for none.
struct PrintedComparison {
  std::string row, first, second;
  int first_failures = 0, second_failures = 0, n = 0;
  double least_p = 1.0, greatest_p = 1.0;
};
std::vector<PrintedComparison> PrintedComparisons();

}  // namespace rcme
