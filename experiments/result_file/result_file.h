// A result file that is open: its tables, read and checked.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>

#include "experiments/result_file/database.h"
#include "experiments/result_file/run_table.h"
#include "experiments/result_file/trial_reader.h"
#include "experiments/result_file/trial_totals.h"

namespace rcme {

// Errors are SQLite::Exception and Damage, for NamingFile.
class ResultFile {
 public:
  ResultFile(const std::string& path, int sqlite_flags);

  // A file that no one has written to, or one whose first run ended before it had made the tables.
  bool IsNew();
  void Create(const StudyPlan& plan);
  // In place of all that the file holds.
  void CreateAnew(const StudyPlan& plan);
  // Reads all there is, and so checks it. Shows progress.
  void Load();
  // Checks what SQLite would write over: its free pages and the trees that hold the tables.
  void CheckPages();

  // Checks that the tables are those of a plan with the same identity.
  void CheckFits(const StudyPlan& plan) const;

  TrialFrame Frame() const;
  void SetValues(const std::map<std::string, std::string>& values);
  // Every trial, or those of one condition; throws Damage at the first that is not sound, or at the end if
  // they are not those that were counted.
  void ForEachTrial(std::optional<std::uint32_t> condition,
                    const std::function<void(const StoredTrial&)>& visit) const;

  const std::string path;
  SQLite::Database database;
  RunTable run;
  TrialTotals totals;
};

}  // namespace rcme
