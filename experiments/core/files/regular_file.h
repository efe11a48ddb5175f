#pragma once

#include <cstddef>
#include <string>

namespace rcme {

// What the messages call a file: "no such `name`", "is a folder, not `article_name`".
struct FileKind {
  std::string name, article_name;
};

// A file opened for reading. Not a folder, a pipe, a socket or a device: reading one may take for ever.
class RegularFile {
 public:
  // Throws InputError that names the path and what is wrong with it.
  RegularFile(const std::string& path, const FileKind& kind);
  ~RegularFile();
  RegularFile(const RegularFile&) = delete;
  RegularFile& operator=(const RegularFile&) = delete;

  // The next bytes, as many as there are up to `max_bytes`. Throws InputError if they cannot be read.
  std::string Read(size_t max_bytes);
  // The descriptor for another owner, who closes it.
  int Release();

 private:
  std::string path_;
  int descriptor_ = -1;
};

}  // namespace rcme
