// The events of a trial whose rates are reported and compared, by name.
#pragma once

#include <string>
#include <vector>

#include "experiments/trial/trial.h"

namespace rcme {

struct TrialEvent {
  std::string name, doc;
  bool (*has_happened)(const TrialRecord&, const FailureBounds&);
  bool needs_truth;

  // Returns whether the record determines if the event has happened. The trial must count (IsCounted); for
  // an event that needs the truth it must be scored.
  bool IsKnownFor(const TrialRecord& record) const {
    return needs_truth ? IsScored(record) : IsCounted(record);
  }
};
const std::vector<TrialEvent>& TrialEvents();
std::vector<std::string> TrialEventNames();

}  // namespace rcme
