#include "experiments/core/files/scratch_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>
#include <unistd.h>

#include <filesystem>

#include "experiments/core/files/owner_lock.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPrefix = "rcme_scratch_";

}  // namespace

ScratchFolder::ScratchFolder() {
  // Another process may take the folder for abandoned before it is locked; then make it again.
  for (int attempt = 0; attempt < 100; ++attempt) {
    std::string name = (fs::temp_directory_path() / kPrefix).string() + "XXXXXX";
    if (!mkdtemp(name.data())) throw InputError(fmt::format("{}: cannot be made", name));
    lock_ = open(name.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (lock_ >= 0 && LockOwn(name, lock_)) {
      path_ = name;
      return;
    }
    if (lock_ >= 0) close(lock_);
  }
  throw InputError("no temporary folder can be made: others remove them");
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  close(lock_);
}

void RemoveAbandonedScratchFolders() {
  std::error_code error;  // folders that cannot be looked at or removed stay
  fs::directory_iterator entry(fs::temp_directory_path(error), error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    std::error_code ignored;
    if (!entry->path().filename().string().starts_with(kPrefix)) continue;
    if (!fs::is_directory(entry->symlink_status(ignored))) continue;
    RemoveIfAbandoned(entry->path().string(), [](const std::string& path) {
      std::error_code left;
      fs::remove_all(path, left);
    });
  }
}

}  // namespace rcme
