#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "experiments/core/files/regular_file.h"

struct gzFile_s;

namespace rcme {

// The lines of a text file, plain or gzip, one at a time: memory does not grow with the file, and neither a
// line without an end nor a small file that unpacks to a huge one is followed far.
class GzipLines {
 public:
  static constexpr size_t kMaxLineBytes = size_t{64} << 10;
  static constexpr size_t kMaxBytes = size_t{256} << 20;  // of text, unpacked

  // Throws InputError as RegularFile does.
  GzipLines(const std::string& path, const FileKind& kind);
  // Of standard input, which messages call so.
  static GzipLines OfStandardInput();

  // The next line without its end, valid until the next call; false after the last one. Throws InputError: a
  // damaged or truncated gzip file, one packed twice, a line or a file that is too long.
  bool Next(std::string_view* line);
  // InputError that names the file and the line that Next gave last.
  [[noreturn]] void Fail(const std::string& what) const;
  int line_number() const { return line_number_; }  // from 1

 private:
  GzipLines(std::string name, int descriptor);
  void CheckEnd() const;

  std::string path_;
  std::unique_ptr<gzFile_s, int (*)(gzFile_s*)> file_;
  std::string line_;
  int line_number_ = 0;
  size_t num_bytes_ = 0;
};

}  // namespace rcme
