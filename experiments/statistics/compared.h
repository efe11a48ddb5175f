// The quantities by which two estimators can be compared on the same trials: events, scores and errors.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/trial/trial.h"

namespace rcme {

enum class ComparedKind {
  kEvent,  // TrialEvents(); their rates are compared
  kScore,  // TrialScores() and the Brier score; their means, in [0, 1], are compared
  kError   // TrialErrors() and scores of the stated density; compared by the median difference of the trials
};
std::string Name(ComparedKind kind);  // "event", "score", "error"

struct Compared {
  ComparedKind kind;
  std::string name, doc;
  // Returns the value of a trial: 0 or 1 for an event, a score, or an error. Nothing if the trial has no
  // value for this estimator. A pair needs both values.
  std::function<std::optional<double>(const TrialRecord&, const FailureBounds&)> of;
  const char* unit = "deg";  // unit of an error
};

// Returns the events, then the scores, then the errors.
const std::vector<Compared>& AllCompared();

// Returns the quantities with these names, each once, in the order of AllCompared. "events", "scores" and
// "errors" select all of a kind. Throws InputError for an unknown name or an empty list.
std::vector<Compared> ComparedByName(const std::vector<std::string>& names);

}  // namespace rcme
