// How a trial ended for one estimator, and the events whose rates are reported and compared, by name.
#pragma once

#include <string>
#include <vector>

#include "experiments/trial/trial.h"

namespace rcme {

// How a trial ended for one estimator. kNotScored: the truth is unknown or in doubt, or the trial was not
// simulated.
enum class TrialOutcome { kSuccess, kFailure, kRefusal, kNotScored };

TrialOutcome ClassifyOutcome(const TrialRecord& record, const FailureBounds& bounds);

// Returns "success", "failure", "refusal" or "not_scored", as all tables, files and pages name them.
const char* Name(TrialOutcome outcome);

// Returns the status, which names the reason of a refusal, an invalid answer, or a trial without a usable
// truth. For status ok: "success", "failure" or "not_scored".
std::string OutcomeInFull(const TrialRecord& record, const FailureBounds& bounds);

// An event of a trial whose rate is reported and compared.
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
