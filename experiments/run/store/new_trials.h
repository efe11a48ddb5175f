#pragma once

#include <optional>
#include <string>

#include "experiments/run/store/new_result_file.h"
#include "experiments/run/store/trial_writer.h"

namespace rcme {

// A new result file (new_result_file.h) with trials of other files, written in one transaction. The trials
// of a part are spread over almost every page, so a transaction per part would write each page again and
// again.
class NewTrials {
 public:
  NewTrials(const std::string& path, const RunDescription& run);

  void Add(const StoredTrial& trial);
  // Reads a trial that was added.
  StoredTrial Read(std::uint32_t condition, std::uint32_t trial);
  // Writes this description and moves the file to its path.
  void Finish(const RunDescription& run);

 private:
  NewResultFile file_;
  std::optional<TrialWriter> writer_;
  std::optional<SQLite::Transaction> transaction_;
};

}  // namespace rcme
