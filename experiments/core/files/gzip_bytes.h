#pragma once

#include <zlib.h>

#include <string>
#include <vector>

namespace rcme {

// Reads the bytes of a file, unpacked if it is a gzip file; its members follow each other. zlib's own reader
// ends at a member whose beginning is damaged, without an error.
class GzipBytes {
 public:
  explicit GzipBytes(int descriptor);  // which it closes
  ~GzipBytes();
  GzipBytes(const GzipBytes&) = delete;
  GzipBytes& operator=(const GzipBytes&) = delete;

  // The next byte, or -1 after the last one, or at a damage.
  int Next() { return at_ < end_ || Fill() ? static_cast<unsigned char>(out_[at_++]) : -1; }
  const std::string& damage() const { return damage_; }  // empty: none so far

 private:
  bool Fill();
  bool FillPlain();
  bool Unpack();
  bool ReadInput();  // false at the end of the file
  bool Begin();

  enum class Kind { kUnknown, kPlain, kGzip };

  int descriptor_;
  Kind kind_ = Kind::kUnknown;
  z_stream stream_{};
  bool is_within_member_ = false;
  std::vector<char> in_, out_;
  size_t at_ = 0, end_ = 0;  // in out_
  std::string damage_;
};

}  // namespace rcme
