// What a trial contributes to each quantity of the summary, and how a row comes of what was collected: for
// the summary of trials (summarize.h) and that of counts (summary_counts.h).
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "experiments/statistics/summarize.h"
#include "experiments/trial/trial.h"
#include "stats/score_mean.h"
#include "stats/stream_median.h"

namespace rcme {

// What a trial contributes to a quantity: nothing (it is not of those the quantity is about), or a number (a
// rate: 0 or 1). `Record` is TrialRecord, for estimators, or ProblemRecord.
template <typename Record>
struct Quantity {
  std::string name;
  SummaryRow::Kind kind;
  std::string doc;
  std::function<std::optional<double>(const Record&, const FailureBounds&)> contribution;
};
using TrialQuantity = Quantity<TrialRecord>;
using ProblemQuantity = Quantity<ProblemRecord>;

const std::vector<TrialQuantity>& TrialQuantities();
const std::vector<ProblemQuantity>& ProblemQuantities();

// The numbers of one quantity, as far as its kind needs them.
struct Collected {
  std::int64_t n = 0;
  double mean = std::numeric_limits<double>::quiet_NaN(), standard_error = mean;
  const StreamMedian* median = nullptr;  // of a median
  const ScoreMean* scores = nullptr;     // of a score, and of a rate where scenes are repeated
};

// Of trials without weights. `row` has what all rows of its cell share; `num_trials` are those of the cell.
void FillRow(const Collected& collected, std::int64_t num_trials, SummaryRow* row);

// Of what is not the same when a run is made again.
bool IsOfTimes(const std::string& quantity);

// Takes away the rows of times, unless asked for, of probabilities, where no estimator states any, and of
// what only estimators outside the program do (timed_out, ...), where none did.
void LeaveOutRows(bool with_times, Summary* summary);

}  // namespace rcme
