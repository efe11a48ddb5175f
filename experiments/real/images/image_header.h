#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace rcme {

// The content of an image file's header, read before anything is decoded.
struct ImageHeader {
  std::string format;
  std::int64_t width = 0, height = 0;  // px; below 1 if the header is damaged
};

// Recognizes PNG, JPEG, TIFF (not BigTIFF), BMP and PNM (P1 to P6) by their first bytes; the format is empty
// for anything else.
ImageHeader ReadImageHeader(std::string_view bytes);

}  // namespace rcme
