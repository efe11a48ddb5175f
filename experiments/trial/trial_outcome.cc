#include "experiments/trial/trial_outcome.h"

namespace rcme {

TrialOutcome ClassifyOutcome(const TrialRecord& record, const FailureBounds& bounds) {
  if (HasRefused(record)) return TrialOutcome::kRefusal;
  if (HasFailed(record, bounds)) return TrialOutcome::kFailure;
  return IsScored(record) ? TrialOutcome::kSuccess : TrialOutcome::kNotScored;
}

const char* Name(TrialOutcome outcome) {
  switch (outcome) {
    case TrialOutcome::kSuccess:
      return "success";
    case TrialOutcome::kFailure:
      return "failure";
    case TrialOutcome::kRefusal:
      return "refusal";
    case TrialOutcome::kNotScored:
      break;
  }
  return "not_scored";
}

std::string OutcomeInFull(const TrialRecord& record, const FailureBounds& bounds) {
  return record.status == MotionStatus::kOk ? Name(ClassifyOutcome(record, bounds))
                                            : StatusName(record.status);
}

}  // namespace rcme
