// What a trial contributes to each quantity of the summary.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/statistics/summarize.h"
#include "experiments/trial/trial.h"

namespace rcme {

// What a trial contributes to a quantity: nothing (it is not of those the quantity is about), or a number (a
// rate: 0 or 1). `Record` is TrialRecord, for estimators, or ProblemRecord.
template <typename Record>
struct Quantity {
  std::string name;
  SummaryRow::Kind kind;
  std::string doc;
  std::function<std::optional<double>(const Record&, const FailureBounds&)> contribution;
  bool (*is_of)(const Record&) = nullptr;  // the records that may contribute; null: all

  std::optional<double> Measure(const Record& record, const FailureBounds& bounds) const {
    return is_of && !is_of(record) ? std::nullopt : contribution(record, bounds);
  }
};
using TrialQuantity = Quantity<TrialRecord>;
using ProblemQuantity = Quantity<ProblemRecord>;

const std::vector<TrialQuantity>& TrialQuantities();
const std::vector<ProblemQuantity>& ProblemQuantities();

// Of what is not the same when a run is made again.
bool IsOfTimes(const std::string& quantity);

// Takes away the rows of times, unless asked for, of probabilities, where no estimator states any, of what
// only estimators outside the program do (timed_out, ...), where none did, of trials that were not simulated,
// where all were, and each of the stated density that no answer of the run has (sd_over_crb of real pairs).
void LeaveOutRows(bool with_times, Summary* summary);

}  // namespace rcme
