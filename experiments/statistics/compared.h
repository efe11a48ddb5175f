// What two estimators can be compared by on the same trials: events, scores, errors.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/trial/trial.h"

namespace rcme {

enum class ComparedKind {
  kEvent,  // TrialEvents(): the rates
  kScore,  // TrialScores(): the means, in [0, 1]
  kError   // TrialErrors() and the scores of the stated density: the median of the trials' differences
};
std::string Name(ComparedKind kind);  // "event", "score", "error"

struct Compared {
  ComparedKind kind;
  std::string name, doc;
  // What a trial gives: 0 or 1, a score, an error. Nothing where it says nothing about the estimator; a pair
  // needs both.
  std::function<std::optional<double>(const TrialRecord&, const FailureBounds&)> of;
  const char* unit = "deg";  // of an error
};

// The events, then the scores, then the errors.
const std::vector<Compared>& AllCompared();

// Those of the names, each once, in the order above; "events", "scores" and "errors" stand for all of a kind.
// Throws InputError on another name, or none.
std::vector<Compared> ComparedByName(const std::vector<std::string>& names);

}  // namespace rcme
