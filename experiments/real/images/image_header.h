#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace rcme {

// What the header of an image file says, before anything is unpacked.
struct ImageHeader {
  std::string format;
  std::int64_t width = 0, height = 0;  // px; below 1: the header is damaged
};

// Knows PNG, JPEG, TIFF (not BigTIFF), BMP and PNM (P1 to P6) by their first bytes; the format of anything
// else is empty.
ImageHeader ReadImageHeader(std::string_view bytes);

}  // namespace rcme
