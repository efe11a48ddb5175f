// Every estimator against one of them, the reference, on the same trials: how much more often does it fail,
// and is that more than chance?
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/result_file/result_store.h"
#include "experiments/trial/trial_event.h"
#include "stats/intervals.h"
#include "stats/paired.h"

namespace rcme {

// One event of one estimator and the reference in one condition.
struct ComparisonRow {
  std::uint32_t condition = 0;
  std::vector<std::string> levels;  // one per factor
  std::string estimator;            // label
  std::string event;
  PairedCounts counts;           // first: the estimator, second: the reference
  double risk_difference = 0.0;  // rate of the estimator minus rate of the reference; NaN where n is 0
  Interval interval;             // of the risk difference: Tango's 95 %
  double p_value = 0.0;          // McNemar's exact test of equal rates; NaN where n is 0
  double holm_p_value = 0.0;     // the same, adjusted for all rows of the comparison that have trials
};

struct Comparison {
  std::string study, reference;
  std::vector<std::string> factor_names;
  std::vector<ComparisonRow> rows;  // by condition, estimator, event; none in a study of one estimator
  std::int64_t num_trials_done = 0, num_trials_planned = 0;
  std::string caution;  // why the rows are not to be taken at their word, or there are none; empty: no reason
};

// One pass over the raw trials, in constant memory. `reference` is a label of the study; empty: its first.
// Throws InputError if the study has no such label.
Comparison Compare(const ResultStore& store, const std::string& reference);

}  // namespace rcme
