// The quantities of the summary, and what a trial contributes to each.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/statistics/summarize.h"
#include "experiments/trial/trial.h"

namespace rcme {

// A quantity of the summary. `Record` is TrialRecord for quantities of estimators, or ProblemRecord.
template <typename Record>
struct Quantity {
  std::string name;
  SummaryRow::Kind kind;
  std::string doc;
  std::string base;  // the records that count, in words
  // Returns the value of a record (0 or 1 for a rate), or nothing if it does not count for the quantity.
  std::function<std::optional<double>(const Record&, const FailureBounds&)> contribution;
  bool (*is_of)(const Record&) = nullptr;  // records that may contribute; null: all

  std::optional<double> Measure(const Record& record, const FailureBounds& bounds) const {
    return is_of && !is_of(record) ? std::nullopt : contribution(record, bounds);
  }
};
using TrialQuantity = Quantity<TrialRecord>;
using ProblemQuantity = Quantity<ProblemRecord>;

const std::vector<TrialQuantity>& TrialQuantities();
const std::vector<ProblemQuantity>& ProblemQuantities();

// Returns whether the quantity differs when a run is repeated.
bool IsOfTimes(const std::string& quantity);

// Removes rows without information: of times, unless requested; of probabilities, if no estimator states
// any; of statuses that only estimators outside the program have (timed_out, ...), if none occurred; of
// trials that were not simulated, if all were; and each quantity of the stated density that no answer has
// (sd_over_crb for real pairs).
void LeaveOutRows(bool with_times, Summary* summary);

}  // namespace rcme
