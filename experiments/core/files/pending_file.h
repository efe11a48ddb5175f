#pragma once

#include <string>

namespace rcme {

// A temporary file beside its final path. PutInPlace moves it there; without that call nothing is left.
// Files of killed processes are removed when a process makes its first temporary file in the same folder:
// the name says which host made the file, and the lock says whether its process still runs (owner_lock.h).
class PendingFile {
 public:
  // Makes an empty file. Throws InputError that names `path` and the reason.
  explicit PendingFile(const std::string& path);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  // The path of the temporary file: PATH.rcme-HOST-PROCESS-NUMBER.part.
  const std::string& part() const { return part_; }
  int descriptor() const { return descriptor_; }  // open for reading and writing

  // Syncs the content to disk, whichever descriptor wrote it, and renames the file to its final path. Throws
  // InputError.
  void PutInPlace();

 private:
  const std::string path_;
  std::string part_;  // empty after PutInPlace
  int descriptor_ = -1;
};

// `error`: errno.
[[noreturn]] void ThrowCannotWrite(const std::string& path, int error);

}  // namespace rcme
