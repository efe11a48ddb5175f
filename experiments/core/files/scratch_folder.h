#pragma once

#include <string>

namespace rcme {

// A folder in the system's temporary directory that is deleted with its content when this object is
// destroyed. The process holds a lock on it, which is released however the process ends.
class ScratchFolder {
 public:
  ScratchFolder();  // throws InputError that names the path if it cannot be made
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  int lock_ = -1;  // file descriptor of the folder
};

// Removes the scratch folders that killed processes of this user left behind, which nobody has locked.
void RemoveAbandonedScratchFolders();

}  // namespace rcme
