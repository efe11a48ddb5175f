#include "experiments/trial_event.h"

namespace rcme {
namespace {

bool HasRefused(const TrialRecord& record, const FailureBounds&) {
  return record.status != MotionStatus::kOk;
}

// Not the same as no success: a motion whose truth is not known is neither.
bool HasFailedOrRefused(const TrialRecord& record, const FailureBounds& bounds) {
  return HasRefused(record, bounds) || HasFailed(record, bounds);
}

}  // namespace

const std::vector<TrialEvent>& TrialEvents() {
  static const std::vector<TrialEvent> events = {
      {"failure", "a motion beyond a failure bound", HasFailed},
      {"refusal", "no motion, for whatever reason", HasRefused},
      {"failure_or_refusal", "one of the two", HasFailedOrRefused}};
  return events;
}

}  // namespace rcme
