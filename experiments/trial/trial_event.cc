#include "experiments/trial/trial_event.h"

#include "experiments/core/text/pick_name.h"

namespace rcme {
namespace {

bool Refused(const TrialRecord& record, const FailureBounds&) { return HasRefused(record); }

}  // namespace

TrialOutcome ClassifyOutcome(const TrialRecord& record, const FailureBounds& bounds) {
  if (HasRefused(record)) return TrialOutcome::kRefusal;
  if (HasFailed(record, bounds)) return TrialOutcome::kFailure;
  return IsScored(record) ? TrialOutcome::kSuccess : TrialOutcome::kNotScored;
}

const char* Name(TrialOutcome outcome) {
  return PickName(outcome, {"success", "failure", "refusal", "not_scored"});
}

std::string OutcomeInFull(const TrialRecord& record, const FailureBounds& bounds) {
  return record.status == MotionStatus::kOk ? Name(ClassifyOutcome(record, bounds))
                                            : StatusName(record.status);
}

const std::vector<TrialEvent>& TrialEvents() {
  static const std::vector<TrialEvent> events = {
      {"failure", "a motion beyond a failure bound, or an answer that is not valid", HasFailed, true},
      {"refusal", "no motion, for whatever reason", Refused, false},
      {"failure_or_refusal", "one of the two", HasFailedOrRefused, true}};
  return events;
}

std::vector<std::string> TrialEventNames() {
  std::vector<std::string> names;
  for (const TrialEvent& event : TrialEvents()) names.push_back(event.name);
  return names;
}

}  // namespace rcme
