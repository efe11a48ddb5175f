#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <vector>

#include "experiments/run/store/result_file.h"

namespace rcme {

// Adds trials with their checksums and totals to a file. A transaction contains whole calls only. Throws
// SQLite::Exception, and std::logic_error for incomplete trials or an unknown condition; an error rolls back
// everything not yet committed.
class TrialWriter {
 public:
  explicit TrialWriter(ResultFile* file);

  // Adds, for each problem, one record per estimator, in the order of the problems. Commits about twice a
  // second.
  void Add(const std::vector<ProblemRecord>& problems, const std::vector<TrialRecord>& records);
  void Commit();
  // Adds one trial within a transaction of the caller, who writes the totals and rolls back after an error.
  void AddTrial(const ProblemRecord& problem, std::span<const TrialRecord> records);

 private:
  using Clock = std::chrono::steady_clock;

  template <typename Action>
  void OrRollBack(Action action);

  ResultFile* file_;
  TrialFrame frame_;
  SQLite::Statement insert_problem_, insert_trial_;
  std::optional<SQLite::Transaction> transaction_;
  Clock::time_point last_commit_ = Clock::now();
};

}  // namespace rcme
