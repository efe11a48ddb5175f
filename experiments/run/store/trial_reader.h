// Reads whole trials from the tables `problems` and `trials`, and checks each.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "experiments/run/store/trial_totals.h"
#include "experiments/trial/trial.h"

namespace rcme {

// The properties of a file that every trial in it must match.
struct TrialFrame {
  std::uint32_t identity = 0;  // checksum of the study's identity
  size_t num_conditions = 0, num_estimators = 0;
};

struct StoredTrial {
  ProblemRecord problem;
  std::vector<TrialRecord> records;  // one per estimator
  std::uint32_t checksum = 0;
};

// Calls `visit` for every trial, ordered by condition and trial; optionally only for one condition. Reads on
// a thread of its own, so `visit` must not use `database`. Throws Damage at the first damaged trial: a
// column has a wrong type or range, trials are out of order, there is not one record per estimator, or the
// checksum is wrong.
void ForEachStoredTrial(const SQLite::Database& database, const TrialFrame& frame,
                        std::optional<std::uint32_t> condition,
                        const std::function<void(const StoredTrial&)>& visit);

// Reads one trial; nothing if the file does not have it.
std::optional<StoredTrial> ReadStoredTrial(const SQLite::Database& database, const TrialFrame& frame,
                                           std::uint32_t condition, std::uint32_t trial);

}  // namespace rcme
