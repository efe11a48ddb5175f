// The trials of a run in which an estimator failed, as a list to look into.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/run/store/result_store.h"

namespace rcme {

struct FailingTrial {
  std::uint32_t condition = 0;
  std::vector<std::string> levels;  // one per factor
  std::uint32_t trial = 0;
  std::string estimator, outcome;  // label; trial_outcome.h
  double rotation_error_deg = 0.0, direction_error_deg = 0.0, failure_probability = 0.0;  // NaN: not known
};

// Which trials to list.
struct FailureQuery {
  std::string event = "failure";        // trial_event.h
  std::vector<std::string> estimators;  // labels; empty: all
  std::optional<std::uint32_t> condition;
  std::int64_t limit = 50;  // the first so many; 0: all
};

struct FailingTrials {
  std::string study;
  std::vector<std::string> factors;
  std::vector<FailingTrial> listed;  // ordered by condition, trial and estimator
  std::int64_t num_found = 0;        // answers, those beyond the limit too
  std::int64_t num_looked_at = 0;    // answers that tell whether the event has happened
};

// Throws InputError for an event, a label or a condition that there is not, and for a trial that is not
// sound.
FailingTrials ListFailingTrials(const ResultStore& store, const FailureQuery& query);

// A row per answer; for people also how many there are, and the command that shows the first.
CommandResult MakeFailuresResult(const FailingTrials& trials, const std::string& run);

}  // namespace rcme
