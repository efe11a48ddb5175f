#pragma once

#include <string>

namespace rcme {

// A folder in the system's place for temporary files, gone with everything in it when this object is.
class ScratchFolder {
 public:
  ScratchFolder();  // throws InputError that names the path if it cannot be made
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace rcme
