// Whole trials from the tables `problems` and `trials`, each one checked.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "experiments/run/store/trial_totals.h"
#include "experiments/trial/trial.h"

namespace rcme {

// What every trial of a file has to fit.
struct TrialFrame {
  std::uint32_t identity = 0;  // checksum of the study's identity
  size_t num_conditions = 0, num_estimators = 0;
};

struct StoredTrial {
  ProblemRecord problem;
  std::vector<TrialRecord> records;  // one per estimator
  std::uint32_t checksum = 0;
};

// Calls `visit` for every trial, ordered by condition and trial; only those of one condition, if it is given.
// Reads on a thread of its own, so that `visit` may not use `database`.
// Throws Damage at the first that is not sound: a column of another type or out of range, out of order, not
// one record per estimator, another checksum.
void ForEachStoredTrial(const SQLite::Database& database, const TrialFrame& frame,
                        std::optional<std::uint32_t> condition,
                        const std::function<void(const StoredTrial&)>& visit);

// The same for one trial; nothing where the file does not hold it.
std::optional<StoredTrial> ReadStoredTrial(const SQLite::Database& database, const TrialFrame& frame,
                                           std::uint32_t condition, std::uint32_t trial);

}  // namespace rcme
