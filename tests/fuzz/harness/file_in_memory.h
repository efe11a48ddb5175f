#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

namespace rcme {

// A file for readers that take a path, without a disk.
class FileInMemory {
 public:
  FileInMemory()
      : descriptor_(memfd_create("input", 0)), path_("/proc/self/fd/" + std::to_string(descriptor_)) {}
  const std::string& path() const { return path_; }
  void Write(const std::uint8_t* data, size_t size) const {
    const auto length = static_cast<ssize_t>(size);
    if (ftruncate(descriptor_, 0) != 0 || pwrite(descriptor_, data, size, 0) != length) std::abort();
  }

 private:
  int descriptor_;
  std::string path_;
};

}  // namespace rcme
