// Lists the trials of a run in which an estimator failed.
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
  std::vector<std::string> levels;  // one level per factor
  std::uint32_t trial = 0;
  std::string estimator, outcome;  // label; outcome of trial_event.h
  double rotation_error_deg = 0.0, direction_error_deg = 0.0, failure_probability = 0.0;  // NaN: not known
};

// Which trials to list.
struct FailureQuery {
  std::string event = "failure";        // trial_event.h
  std::vector<std::string> estimators;  // labels; empty: all
  std::optional<std::uint32_t> condition;
  std::int64_t limit = 50;  // maximum number of listed answers; 0: all
};

struct FailingTrials {
  std::string study;
  std::vector<std::string> factors;
  std::vector<FailingTrial> listed;  // ordered by condition, trial and estimator
  std::int64_t num_found = 0;        // matching answers, also those beyond the limit
  std::int64_t num_looked_at = 0;    // answers that determine whether the event has happened
};

// Throws InputError for an unknown event, label or condition, and for a damaged trial.
FailingTrials ListFailingTrials(const ResultStore& store, const FailureQuery& query);

// Makes a row per answer. For people it adds the number found and the command that shows the first.
CommandResult MakeFailuresResult(const FailingTrials& trials, const std::string& run);

}  // namespace rcme
