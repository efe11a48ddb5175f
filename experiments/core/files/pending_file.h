#pragma once

#include <string>

namespace rcme {

// A file in the making, beside the place that it takes at PutInPlace; without that call nothing is left of
// it. What a killed process leaves is removed by the next that makes a file in the same folder: its name says
// which host made it, and the lock on it whether its process still runs (owner_lock.h).
class PendingFile {
 public:
  // Makes an empty file. Throws InputError that names `path` and the reason.
  explicit PendingFile(const std::string& path);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  // Where it is made: PATH.rcme-HOST-PROCESS-NUMBER.part.
  const std::string& part() const { return part_; }
  int descriptor() const { return descriptor_; }  // open for reading and writing

  // What was written, by whatever descriptor, goes to the disk first and then takes its place. Throws
  // InputError.
  void PutInPlace();

 private:
  const std::string path_;
  std::string part_;  // empty: it has taken its place
  int descriptor_ = -1;
};

// `error`: errno.
[[noreturn]] void ThrowCannotWrite(const std::string& path, int error);

}  // namespace rcme
