// What may happen to an estimator in a trial, by name: the events whose rates are compared and asked for.
#pragma once

#include <string>
#include <vector>

#include "experiments/trial/trial.h"

namespace rcme {

struct TrialEvent {
  std::string name, doc;
  bool (*has_happened)(const TrialRecord&, const FailureBounds&);
  bool needs_truth;  // says nothing of a trial that is not scored
};
const std::vector<TrialEvent>& TrialEvents();
std::vector<std::string> TrialEventNames();

}  // namespace rcme
