// CRC-32 of file contents. It detects accidents: every flip of one bit of a number or a text, and any other
// change with probability 1 - 2^-32. It is not a signature: whoever changes a file on purpose can compute it
// again.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rcme {

// Values as bytes, little-endian whatever the machine, in which nothing can pass for something else.
class ChecksumBytes {
 public:
  explicit ChecksumBytes(size_t expected_size) { bytes_.reserve(expected_size); }

  void Add(const std::string& text);
  void Add(double number);  // every NaN is the same
  void Add(std::uint64_t word);

  std::uint32_t Checksum() const;

 private:
  std::string bytes_;
};

// Of some texts in order; where one ends and the next begins counts.
std::uint32_t ComputeChecksum(const std::vector<std::string>& texts);

}  // namespace rcme
