#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rcme {

struct GreyImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> grey;  // row by row
};

// The bytes of an image file. Throws InputError: no such file, not a file, too large to be one image.
std::string ReadImageBytes(const std::string& path);

// Unpacks PNG, JPEG, TIFF, BMP or PNM, at most 4096 x 4096 px; `path` is what messages call it. Throws
// InputError: another format, too large, damaged, cut off.
GreyImage UnpackImage(std::string bytes, const std::string& path);

}  // namespace rcme
