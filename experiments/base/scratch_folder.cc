#include "experiments/base/scratch_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "parameters/input_error.h"

namespace rcme {
namespace {

constexpr const char* kPrefix = "rcme_scratch_";

// A descriptor of the folder that closes with the process and is not handed to the programs it starts; -1 if
// there is no such folder (a symbolic link does not count).
int OpenFolder(const std::string& path) {
  return open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

// Whether the path still names the folder of the descriptor.
bool IsStillThere(const std::string& path, int folder) {
  struct stat by_path {
  }, by_descriptor{};
  return lstat(path.c_str(), &by_path) == 0 && fstat(folder, &by_descriptor) == 0 &&
         by_path.st_dev == by_descriptor.st_dev && by_path.st_ino == by_descriptor.st_ino;
}

bool IsOwn(int folder) {
  struct stat status {};
  return fstat(folder, &status) == 0 && status.st_uid == geteuid();
}

}  // namespace

ScratchFolder::ScratchFolder() {
  // Between making the folder and locking it another process may take it for abandoned: then again.
  for (int attempt = 0; attempt < 100; ++attempt) {
    std::string name = (std::filesystem::temp_directory_path() / kPrefix).string() + "XXXXXX";
    if (!mkdtemp(name.data())) throw InputError(fmt::format("{}: cannot be made", name));
    lock_ = OpenFolder(name);
    const bool is_taken = lock_ < 0 || (flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK);
    if (!is_taken && IsStillThere(name, lock_)) {
      path_ = name;
      return;
    }
    if (lock_ >= 0) close(lock_);
  }
  throw InputError("no temporary folder can be made: others remove them");
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
  close(lock_);
}

void RemoveAbandonedScratchFolders() {
  std::error_code error;  // whatever cannot be looked at or removed stays
  std::filesystem::directory_iterator entry(std::filesystem::temp_directory_path(error), error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    if (!entry->path().filename().string().starts_with(kPrefix)) continue;
    const int folder = OpenFolder(entry->path().string());
    if (folder < 0) continue;
    // The lock is held while the folder is removed, so that nobody can begin to use it meanwhile.
    std::error_code ignored;
    if (IsOwn(folder) && flock(folder, LOCK_EX | LOCK_NB) == 0 && IsStillThere(entry->path(), folder))
      std::filesystem::remove_all(entry->path(), ignored);
    close(folder);
  }
}

}  // namespace rcme
