#include "experiments/core/files/owner_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

namespace rcme {
namespace {

// Opens a file for writing, as network file systems require for a lock, and a folder for reading. The
// descriptor is closed with the process; programs that it starts do not inherit it.
int OpenToLock(const std::string& path) {
  constexpr int kFlags = O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
  const int file = open(path.c_str(), O_RDWR | kFlags);
  return file < 0 && errno == EISDIR ? open(path.c_str(), O_RDONLY | O_DIRECTORY | kFlags) : file;
}

// Returns whether `path` still names what `descriptor` is open on.
bool IsStillThere(const std::string& path, int descriptor) {
  struct stat by_path {
  }, by_descriptor{};
  return lstat(path.c_str(), &by_path) == 0 && fstat(descriptor, &by_descriptor) == 0 &&
         by_path.st_dev == by_descriptor.st_dev && by_path.st_ino == by_descriptor.st_ino;
}

bool IsOfThisUser(int descriptor) {
  struct stat status {};
  return fstat(descriptor, &status) == 0 && status.st_uid == geteuid() &&
         (S_ISREG(status.st_mode) || S_ISDIR(status.st_mode));
}

}  // namespace

bool LockOwn(const std::string& path, int descriptor) {
  const bool is_taken = flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  return !is_taken && IsStillThere(path, descriptor);
}

void RemoveIfAbandoned(const std::string& path, void (*remove)(const std::string& path)) {
  const int descriptor = OpenToLock(path);
  if (descriptor < 0) return;
  // The lock is held during the removal, so nobody can begin to use the file meanwhile.
  if (IsOfThisUser(descriptor) && flock(descriptor, LOCK_EX | LOCK_NB) == 0 && IsStillThere(path, descriptor))
    remove(path);
  close(descriptor);
}

}  // namespace rcme
