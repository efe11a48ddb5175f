// A result file that is open: its tables, read and checked.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "experiments/core/files/database.h"
#include "experiments/run/store/description_tables.h"
#include "experiments/run/store/trial_reader.h"
#include "experiments/run/store/trial_totals.h"

namespace rcme {

// Errors are SQLite::Exception and Damage, for NamingFile.
class ResultFile {
 public:
  ResultFile(const std::string& path, int sqlite_flags, FileLocks locks = FileLocks::kUsed);

  // A file that no one has written to, or one whose first run ended before it had made the tables.
  bool IsNew();
  void Create(const RunDescription& run);
  // In place of all that the file holds.
  void CreateAnew(const RunDescription& run);
  // Reads and checks everything but the trials.
  void LoadDescription();
  // Reads all trials, and so checks them. Shows progress.
  void CheckTrials() const;
  // Checks what SQLite would write over: its free pages and the trees that hold the tables.
  void CheckPages();

  TrialFrame Frame() const;
  void SetDescription(const RunDescription& run);
  // Takes out the whole trials in which an estimator ended with one of these statuses, and notes their number
  // as trials that are run again. Returns it; where it is 0, nothing is written.
  std::int64_t RemoveForRetry(const std::vector<MotionStatus>& statuses);
  // Every trial, or those of one condition; throws Damage at the first that is not sound, or at the end if
  // they are not those that were counted.
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
