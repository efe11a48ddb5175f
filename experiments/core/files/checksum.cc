#include "experiments/core/files/checksum.h"

#include <zlib.h>

#include <bit>
#include <cmath>

namespace rcme {

void ChecksumBytes::Add(const std::string& text) {
  Add(std::uint64_t{text.size()});
  bytes_ += text;
}

void ChecksumBytes::Add(double number) {
  Add(std::isnan(number) ? ~std::uint64_t{0} : std::bit_cast<std::uint64_t>(number));
}

void ChecksumBytes::Add(std::uint64_t word) {
  char bytes[8];
  for (int i = 0; i < 8; ++i) bytes[i] = static_cast<char>(word >> (8 * i));
  bytes_.append(bytes, sizeof(bytes));
}

std::uint32_t ChecksumBytes::Checksum() const {
  const auto* data = reinterpret_cast<const Bytef*>(bytes_.data());
  return static_cast<std::uint32_t>(crc32_z(0, data, bytes_.size()));
}

std::uint32_t ComputeChecksum(const std::vector<std::string>& texts) {
  ChecksumBytes bytes(0);
  for (const std::string& text : texts) bytes.Add(text);
  return bytes.Checksum();
}

}  // namespace rcme
