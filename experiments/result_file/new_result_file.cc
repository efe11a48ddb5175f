#include "experiments/result_file/new_result_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "experiments/result_file/open_for_run.h"
#include "parameters/input_error.h"

namespace rcme {

NewResultFile::NewResultFile(const std::string& path, const RunDescription& run)
    : path_(path), part_(fmt::format("{}.{}.part", path, getpid())) {
  CheckPathToWrite(path);
  if (std::filesystem::exists(path))
    throw InputError(fmt::format("{}: exists already; give a new file", path));
  std::filesystem::remove(part_);
  NamingFile(path_, [&] {
    file_.emplace(part_, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, FileLocks::kNone);
    // No other process reads it, and after a crash it is made again.
    file_->database.exec(
        "PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF; PRAGMA cache_size = -262144");
    file_->Create(run);
  });
}

NewResultFile::~NewResultFile() {
  file_.reset();
  std::error_code ignored;
  std::filesystem::remove(part_, ignored);
}

void NewResultFile::Finish(const RunDescription& run) {
  NamingFile(path_, [&] {
    file_->SetDescription(run);
    file_.reset();
  });
  const int descriptor = open(part_.c_str(), O_RDONLY | O_CLOEXEC);
  const bool is_safe = descriptor >= 0 && fsync(descriptor) == 0;
  const int error = errno;
  if (descriptor >= 0) close(descriptor);
  if (is_safe && std::rename(part_.c_str(), path_.c_str()) == 0) return;
  throw InputError(fmt::format("{}: cannot be written: {}", path_, std::strerror(is_safe ? errno : error)));
}

}  // namespace rcme
