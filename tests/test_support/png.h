#pragma once

#include <zlib.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace rcme {

// The bytes of a PNG of 8 bits, `grey` row by row: signature, IHDR, IDAT, IEND, each chunk with its CRC. No
// library of images is needed: that of OpenCV takes longer to load than most tests run.
inline std::string GreyPng(std::uint32_t width, const std::vector<std::uint8_t>& grey) {
  const auto big_endian = [](std::uint32_t x) {
    return std::string{static_cast<char>(x >> 24), static_cast<char>(x >> 16), static_cast<char>(x >> 8),
                       static_cast<char>(x)};
  };
  const auto chunk = [&](const std::string& type, const std::string& data) {
    const std::string body = type + data;
    const auto crc = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
    return big_endian(static_cast<std::uint32_t>(data.size())) + body +
           big_endian(static_cast<std::uint32_t>(crc));
  };
  std::string rows;  // each after the number of its filter, 0: none
  rows.reserve(grey.size() + grey.size() / width);
  for (size_t i = 0; i < grey.size(); ++i) {
    if (i % width == 0) rows += '\0';
    rows += static_cast<char>(grey[i]);
  }
  std::string packed(compressBound(rows.size()), '\0');
  uLongf size = packed.size();
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
                rows.size(), Z_BEST_SPEED) != Z_OK) {
    throw std::runtime_error("zlib cannot pack");
  }
  const auto height = static_cast<std::uint32_t>(grey.size() / width);
  return "\x89PNG\r\n\x1A\n" +
         chunk("IHDR", big_endian(width) + big_endian(height) + std::string("\x08\0\0\0\0", 5)) +
         chunk("IDAT", packed.substr(0, size)) + chunk("IEND", "");
}

}  // namespace rcme
