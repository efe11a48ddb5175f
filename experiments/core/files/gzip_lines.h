#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "experiments/core/files/gzip_bytes.h"
#include "experiments/core/files/regular_file.h"

namespace rcme {

// Reads a plain or gzip text file line by line. Memory does not grow with the file; the limits below stop a
// line that never ends and a small file that unpacks to a huge one.
class GzipLines {
 public:
  static constexpr size_t kMaxLineBytes = size_t{64} << 10;
  static constexpr size_t kMaxBytes = size_t{256} << 20;  // unpacked

  // Throws InputError as RegularFile does.
  GzipLines(const std::string& path, const FileKind& kind);
  // Reads standard input; messages call it "standard input".
  static GzipLines OfStandardInput();

  // Reads the next line, without its end; it is valid until the next call. Returns false after the last
  // line. Throws InputError if the gzip file is damaged, truncated or packed twice, or if a line or the file
  // is too long.
  bool Next(std::string_view* line);
  // Throws InputError with the file and the number of the last line read.
  [[noreturn]] void Fail(const std::string& what) const;
  int line_number() const { return line_number_; }  // from 1

 private:
  GzipLines(std::string name, int descriptor);
  void CheckEnd() const;

  std::string path_;
  std::unique_ptr<GzipBytes> bytes_;
  std::string line_;
  int line_number_ = 0;
  size_t num_bytes_ = 0;
};

}  // namespace rcme
