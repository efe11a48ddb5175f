#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rcme {

struct GreyImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> grey;  // row by row
  // Each pixel is the mean of scale x scale pixels of the file, which has full_width x full_height of them:
  // its pixel x stands for scale x + (scale - 1) / 2. What is left over at the right and below is cut off.
  int scale = 1;
  int full_width = 0, full_height = 0;
};

// The bytes of an image file. Throws InputError: no such file, not a file, too large to be one image.
std::string ReadImageBytes(const std::string& path);

// Unpacks PNG, JPEG, TIFF, BMP or PNM of up to 268 megapixels; `path` is what messages call it. One of more
// than 4096 x 4096 px is scaled down by the least whole number that makes it smaller. Of 16 bits the upper
// eight of those in use are taken: 12 where no value is beyond 4,095. Throws InputError: another format, too
// large, damaged, cut off, numbers that are not of 8 or 16 bits.
GreyImage UnpackImage(std::string bytes, const std::string& path);

}  // namespace rcme
