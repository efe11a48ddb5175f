#pragma once

#include <string>

namespace rcme {

// A folder in the system's place for temporary files, gone with everything in it when this object is. Its
// process holds a lock on it, which ends with the process however that ends.
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

// Removes what killed processes of this user left behind: scratch folders that nobody holds a lock on.
void RemoveAbandonedScratchFolders();

}  // namespace rcme
