// An open result file; its tables are checked as they are read.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "experiments/core/files/database.h"
#include "experiments/run/store/description_tables.h"
#include "experiments/run/store/trial_reader.h"
#include "experiments/run/store/trial_totals.h"

namespace rcme {

// Throws InputError that says what is at the path, unless it is a regular file.
void RequireResultFile(const std::string& path);

// Throws SQLite::Exception and Damage; callers use NamingFile to translate them.
class ResultFile {
 public:
  ResultFile(const std::string& path, int sqlite_flags, FileLocks locks = FileLocks::kUsed);

  // Returns whether nothing was ever written to the file, or its first run ended before it had made the
  // tables.
  bool IsNew();
  // Replaces all content of the file.
  void Create(const RunDescription& run);
  // Reads and checks everything except the trials.
  void LoadDescription();
  // Checks all trials by reading them. Shows progress.
  void CheckTrials() const;
  // Checks what SQLite would overwrite: its free pages and the trees of the tables.
  void CheckPages();

  TrialFrame Frame() const;
  void SetDescription(const RunDescription& run);
  // Removes all trials in which an estimator has one of these statuses, and notes how many, to be run again.
  // Returns their number; writes nothing if it is 0.
  std::int64_t RemoveForRetry(const std::vector<MotionStatus>& statuses);
  // Calls `visit` for every trial, or for those of one condition. Throws Damage at the first damaged trial,
  // or at the end if the trials do not match the totals.
  void ForEachTrial(std::optional<std::uint32_t> condition,
                    const std::function<void(const StoredTrial&)>& visit) const;

  const std::string path;
  SQLite::Database database;
  RunDescription description;
  TrialTotals totals;

 private:
  void CheckHasNoCounts();
};

}  // namespace rcme
