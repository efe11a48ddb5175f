// The table of the paper (table::real-data-test), as counts.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "stats/intervals.h"

namespace rcme {

struct PrintedDataset {
  const char* name;
  bool is_indoor;
  int num_pairs;
  int rcme_detect_fail, rcme_failure, prcme_detect_fail, prcme_failure, standard_failure;
};

// The paper prints shares in per cent to two decimals; each of them is that of one number of pairs alone.
std::span<const PrintedDataset> PrintedDatasets();

// One method over the indoor or the outdoor datasets, or one dataset.
struct PrintedRate {
  std::string row, method, quantity;  // RCME, pRCME, Standard; detect_fail, failure
  int count = 0, n = 0;
  Interval interval;  // exact binomial, as if pairs were independent
};
// Every dataset, then "indoor" and "outdoor".
std::vector<PrintedRate> PrintedRates();

// Failures of two methods on the same pairs. How many pairs both fail on is not printed: McNemar's exact
// p-value where as many as possible are the same, and where none is.
struct PrintedComparison {
  std::string row, first, second;
  int first_failures = 0, second_failures = 0, n = 0;
  double least_p = 1.0, greatest_p = 1.0;
};
std::vector<PrintedComparison> PrintedComparisons();

}  // namespace rcme
