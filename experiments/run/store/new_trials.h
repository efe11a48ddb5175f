#pragma once

#include <optional>
#include <string>

#include "experiments/run/store/new_result_file.h"
#include "experiments/run/store/trial_writer.h"

namespace rcme {

// A result file in the making (new_result_file.h) with trials of other files, in one transaction: the trials
// of a part lie on almost every page, which would be written again with each.
class NewTrials {
 public:
  NewTrials(const std::string& path, const RunDescription& run);

  void Add(const StoredTrial& trial);
  // One that was added.
  StoredTrial Read(std::uint32_t condition, std::uint32_t trial);
  // With this description at last.
  void Finish(const RunDescription& run);

 private:
  NewResultFile file_;
  std::optional<TrialWriter> writer_;
  std::optional<SQLite::Transaction> transaction_;
};

}  // namespace rcme
