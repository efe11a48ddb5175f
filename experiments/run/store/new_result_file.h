#pragma once

#include <optional>
#include <string>

#include "experiments/core/files/pending_file.h"
#include "experiments/run/store/result_file.h"

namespace rcme {

// A result file in the making, beside the place that it takes at Finish; without that nothing is left of it.
// Throws InputError that names the path if it cannot be written, or exists.
class NewResultFile {
 public:
  NewResultFile(const std::string& path, const RunDescription& run);

  const std::string& path() const { return path_; }
  ResultFile& file() { return *file_; }
  // With this description at last. No transaction is open.
  void Finish(const RunDescription& run);

 private:
  const std::string path_;
  std::optional<PendingFile> pending_;
  std::optional<ResultFile> file_;  // closed before it is put in place, or removed
};

}  // namespace rcme
