// What may happen to an estimator in a trial, by name: the events whose rates are compared and asked for.
#pragma once

#include <string>
#include <vector>

#include "experiments/trial/trial.h"

namespace rcme {

struct TrialEvent {
  std::string name, doc;
  bool (*has_happened)(const TrialRecord&, const FailureBounds&);
  bool needs_truth;

  // Whether the record says if it has happened: not of a trial that does not count (IsCounted), nor, if it
  // needs the truth, of one that is not scored.
  bool IsKnownFor(const TrialRecord& record) const {
    return needs_truth ? IsScored(record) : IsCounted(record);
  }
};
const std::vector<TrialEvent>& TrialEvents();
std::vector<std::string> TrialEventNames();

}  // namespace rcme
