// CRC-32 of file contents. It detects accidental damage: every single-bit flip in a number or a text, and
// any other change with probability 1 - 2^-32. It is no protection against deliberate changes, because
// anybody can recompute it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rcme {

// Collects values as bytes for a checksum. The encoding is little-endian on every machine and unambiguous: a
// text is preceded by its length.
class ChecksumBytes {
 public:
  explicit ChecksumBytes(size_t expected_size) { bytes_.reserve(expected_size); }

  void Add(const std::string& text);
  void Add(double number);  // all NaNs give the same bytes
  void Add(std::uint64_t word);

  std::uint32_t Checksum() const;

 private:
  std::string bytes_;
};

// The checksum of a sequence of texts. It also depends on where one text ends and the next begins.
std::uint32_t ComputeChecksum(const std::vector<std::string>& texts);

}  // namespace rcme
