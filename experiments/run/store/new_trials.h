#pragma once

#include <optional>
#include <string>

#include "experiments/core/files/pending_file.h"
#include "experiments/run/store/result_file.h"
#include "experiments/run/store/trial_writer.h"

namespace rcme {

// A new result file, written beside its final path. Finish moves it there; without that call nothing is
// left. Throws InputError that names the path if it cannot be written or exists.
class NewResultFile {
 public:
  NewResultFile(const std::string& path, const RunDescription& run);

  const std::string& path() const { return path_; }
  ResultFile& file() { return *file_; }
  // Writes this description and moves the file to its path. No transaction may be open.
  void Finish(const RunDescription& run);

 private:
  const std::string path_;
  std::optional<PendingFile> pending_;
  std::optional<ResultFile> file_;  // closed before the file is moved or removed
};

// A new result file with trials of other files, written in one transaction. The trials of a part are spread
// over almost every page, so a transaction per part would write each page again and again.
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
