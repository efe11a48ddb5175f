#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <vector>

#include "experiments/run/store/result_file.h"

namespace rcme {

// Adds trials to a file, with their checksums and the totals, in transactions that hold whole calls only.
// Errors are SQLite::Exception and, for trials that are not whole or of no condition, std::logic_error; they
// take back all that was not committed.
class TrialWriter {
 public:
  explicit TrialWriter(ResultFile* file);

  // To each problem one record per estimator, in the problems' order. Commits about twice a second.
  void Add(const std::vector<ProblemRecord>& problems, const std::vector<TrialRecord>& records);
  void Commit();
  // The same for one trial in a transaction of the caller's, who writes the totals and takes back what fails.
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
