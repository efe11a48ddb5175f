#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rcme {

struct GreyImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> grey;  // row by row
  // Each pixel is the mean of scale x scale pixels of the file, whose size is full_width x full_height.
  // Pixel x is centred at scale x + (scale - 1) / 2 of the file. Remaining pixels at the right and bottom
  // are cut off.
  int scale = 1;
  int full_width = 0, full_height = 0;
};

// Reads the bytes of an image file. Throws InputError if the file does not exist, is no regular file or is
// too large for an image.
std::string ReadImageBytes(const std::string& path);

// Decodes PNG, JPEG, TIFF, BMP or PNM of up to 268 megapixels; messages call it `path`. An image of more
// than 4096 x 4096 pixels is scaled down by the least integer that makes it smaller. 16-bit values are
// reduced to the upper eight of the bits in use, such as 12 if no value exceeds 4,095. Throws InputError if
// the image has another format, is too large, damaged or truncated, or has other values than 8 or 16 bits.
GreyImage UnpackImage(std::string bytes, const std::string& path);

}  // namespace rcme
