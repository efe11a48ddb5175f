#include "experiments/real/images/image_header.h"

#include <algorithm>

namespace rcme {
namespace {

enum class ByteOrder { kBig, kLittle };

// Returns the unsigned number of `count` bytes at `at`; 0 beyond the end.
std::int64_t NumberAt(std::string_view bytes, size_t at, size_t count, ByteOrder order) {
  if (at > bytes.size() || count > bytes.size() - at) return 0;
  std::int64_t number = 0;
  for (size_t i = 0; i < count; ++i) {
    const size_t next = order == ByteOrder::kBig ? i : count - 1 - i;
    number = number << 8 | static_cast<unsigned char>(bytes[at + next]);
  }
  return number;
}

// Reads the first chunk: length, "IHDR", width, height (PNG specification, 11.2.2).
ImageHeader Png(std::string_view bytes) {
  ImageHeader header{"PNG"};
  if (bytes.substr(std::min<size_t>(12, bytes.size()), 4) != "IHDR") return header;
  header.width = NumberAt(bytes, 16, 4, ByteOrder::kBig);
  header.height = NumberAt(bytes, 20, 4, ByteOrder::kBig);
  return header;
}

// The frame header follows other segments, each with its length. It is one of SOF0 to SOF15 without DHT, JPG
// and DAC (ITU T.81, B.1).
ImageHeader Jpeg(std::string_view bytes) {
  ImageHeader header{"JPEG"};
  for (size_t at = 2; at + 4 <= bytes.size();) {
    const std::int64_t lead = NumberAt(bytes, at, 1, ByteOrder::kBig);
    const std::int64_t marker = NumberAt(bytes, at + 1, 1, ByteOrder::kBig);
    const bool has_no_length = marker == 0x01 || (marker >= 0xD0 && marker <= 0xD7);
    if (lead != 0xFF || marker == 0x00 || marker == 0xFF) {
      ++at;  // fill bytes
    } else if (marker == 0xD9 || marker == 0xDA) {
      return header;  // the end, or data, without a frame header
    } else if (has_no_length) {
      at += 2;
    } else if (marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC) {
      header.height = NumberAt(bytes, at + 5, 2, ByteOrder::kBig);
      header.width = NumberAt(bytes, at + 7, 2, ByteOrder::kBig);
      return header;
    } else {
      at += 2 + static_cast<size_t>(NumberAt(bytes, at + 2, 2, ByteOrder::kBig));
    }
  }
  return header;
}

// Reads width and height, which have 16 bits in the oldest form. A negative height means that rows go from
// the top.
ImageHeader Bmp(std::string_view bytes) {
  constexpr std::int64_t kOldestHeaderBytes = 12;
  ImageHeader header{"BMP"};
  if (NumberAt(bytes, 14, 4, ByteOrder::kLittle) == kOldestHeaderBytes) {
    header.width = NumberAt(bytes, 18, 2, ByteOrder::kLittle);
    header.height = NumberAt(bytes, 20, 2, ByteOrder::kLittle);
  } else {
    header.width = NumberAt(bytes, 18, 4, ByteOrder::kLittle);
    const auto height = static_cast<std::int32_t>(NumberAt(bytes, 22, 4, ByteOrder::kLittle));
    header.height = std::max<std::int64_t>(height, -static_cast<std::int64_t>(height));
  }
  return header;
}

// Parses "P5 # comment\n 640 480". Numbers have at most ten digits, more than any limit.
ImageHeader Pnm(std::string_view bytes) {
  ImageHeader header{"PNM"};
  size_t at = 2;
  for (std::int64_t* number : {&header.width, &header.height}) {
    while (at < bytes.size() && (bytes[at] < '0' || bytes[at] > '9')) {
      at = bytes[at] == '#' ? std::min(bytes.find('\n', at), bytes.size()) : at + 1;
    }
    for (; at < bytes.size() && bytes[at] >= '0' && bytes[at] <= '9'; ++at) {
      if (*number < 1'000'000'000) *number = 10 * *number + (bytes[at] - '0');
    }
  }
  return header;
}

// Returns the value of a TIFF directory entry: tag, type, count, value (TIFF 6.0, section 2). 0 if the tag
// is missing, -1 if it occurs twice or has a type that sizes do not have.
std::int64_t TiffValue(std::string_view bytes, ByteOrder order, std::int64_t tag) {
  constexpr size_t kEntryBytes = 12;
  constexpr std::int64_t kShort = 3, kLong = 4;
  const auto directory = static_cast<size_t>(NumberAt(bytes, 4, 4, order));
  const auto num_entries = static_cast<size_t>(NumberAt(bytes, directory, 2, order));
  std::int64_t value = 0;
  for (size_t i = 0; i < num_entries; ++i) {
    const size_t at = directory + 2 + i * kEntryBytes;
    if (NumberAt(bytes, at, 2, order) != tag) continue;
    const std::int64_t type = NumberAt(bytes, at + 2, 2, order);
    if (value != 0 || (type != kShort && type != kLong)) return -1;
    value = NumberAt(bytes, at + 8, type == kShort ? 2 : 4, order);
  }
  return value;
}

ImageHeader Tiff(std::string_view bytes, ByteOrder order) {
  constexpr std::int64_t kImageWidth = 256, kImageLength = 257;
  return {"TIFF", TiffValue(bytes, order, kImageWidth), TiffValue(bytes, order, kImageLength)};
}

}  // namespace

ImageHeader ReadImageHeader(std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.starts_with("\x89PNG\r\n\x1A\n")) return Png(bytes);
  if (bytes.starts_with("\xFF\xD8\xFF")) return Jpeg(bytes);
  if (bytes.starts_with("II*\0"sv)) return Tiff(bytes, ByteOrder::kLittle);
  if (bytes.starts_with("MM\0*"sv)) return Tiff(bytes, ByteOrder::kBig);
  if (bytes.starts_with("BM")) return Bmp(bytes);
  if (bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6') return Pnm(bytes);
  return {};
}

}  // namespace rcme
