#pragma once

#include <cstddef>
#include <string>

namespace rcme {

// The names of a kind of file for messages: "no such `name`", "is a folder, not `article_name`".
struct FileKind {
  std::string name, article_name;
};

// A file opened for reading. Folders, pipes, sockets and devices are refused: reading one may block for
// ever.
class RegularFile {
 public:
  // Throws InputError that names the path and what is wrong with it.
  RegularFile(const std::string& path, const FileKind& kind);
  ~RegularFile();
  RegularFile(const RegularFile&) = delete;
  RegularFile& operator=(const RegularFile&) = delete;

  // Reads up to `max_bytes` of the following bytes; fewer at the end of the file. Throws InputError if
  // reading fails.
  std::string Read(size_t max_bytes);
  // Hands over the descriptor; the caller closes it.
  int Release();

 private:
  std::string path_;
  int descriptor_ = -1;
};

}  // namespace rcme
