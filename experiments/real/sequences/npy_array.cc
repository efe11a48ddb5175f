// NumPy's `.npy` format, versions 1 and 2: a magic text, the version, the length of a header, the header (a
// dictionary of Python: descr, fortran_order, shape), then the numbers.
#include <fmt/format.h>

#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>

#include "experiments/real/sequences/npz_file.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

constexpr std::string_view kNpyMagic = "\x93NUMPY";
constexpr std::string_view kKnownDescr = "little-endian f2, f4, f8, i4 and i8 are allowed";

// Little-endian, two's complement or IEEE 754.
struct NpyType {
  std::string_view descr;
  size_t num_bytes;
  bool is_whole;
};
constexpr std::array<NpyType, 5> kNpyTypes = {
    {{"<f2", 2, false}, {"<f4", 4, false}, {"<f8", 8, false}, {"<i4", 4, true}, {"<i8", 8, true}}};

struct NpyHeader {
  std::optional<NpyType> type;
  std::optional<bool> is_fortran_order;
  std::optional<std::vector<size_t>> shape;
};

// Parses the header's dictionary, as numpy writes it.
class NpyHeaderParser {
 public:
  NpyHeaderParser(std::string_view text, const std::string& place) : text_(text), place_(place) {}

  NpyHeader Parse() {
    NpyHeader header;
    Need('{');
    while (!Take('}')) {
      ParseEntry(&header);
      if (Take(',')) continue;
      Need('}');
      break;
    }
    SkipBlanks();
    if (!text_.empty() || !header.type || !header.is_fortran_order || !header.shape) Fail();
    return header;
  }

 private:
  [[noreturn]] void Fail() const {
    throw InputError(
        place_ + ": its header is damaged; {'descr': '<f4', 'fortran_order': False, 'shape': (3, 2)} is one");
  }
  void SkipBlanks() {
    while (!text_.empty() && (text_.front() == ' ' || text_.front() == '\n')) text_.remove_prefix(1);
  }
  bool Take(char c) {
    SkipBlanks();
    if (text_.empty() || text_.front() != c) return false;
    text_.remove_prefix(1);
    return true;
  }
  void Need(char c) {
    if (!Take(c)) Fail();
  }
  bool TakeWord(std::string_view word) {
    SkipBlanks();
    if (!text_.starts_with(word)) return false;
    text_.remove_prefix(word.size());
    return true;
  }

  void ParseEntry(NpyHeader* header) {
    const std::string key = ParseText();
    Need(':');
    if (key == "descr" && !header->type) {
      header->type = ParseType();
    } else if (key == "fortran_order" && !header->is_fortran_order) {
      header->is_fortran_order = TakeWord("True");
      if (!*header->is_fortran_order && !TakeWord("False")) Fail();
    } else if (key == "shape" && !header->shape) {
      header->shape = ParseShape();
    } else {
      Fail();
    }
  }
  std::string ParseText() {
    const char quote = Take('"') ? '"' : '\'';
    if (quote == '\'') Need('\'');
    const size_t end = text_.find(quote);
    if (end == std::string_view::npos) Fail();
    const std::string text(text_.substr(0, end));
    text_.remove_prefix(end + 1);
    return text;
  }
  NpyType ParseType() {
    if (Take('[')) throw InputError(fmt::format("{}: has named columns; {}", place_, kKnownDescr));
    const std::string descr = ParseText();
    for (const NpyType& type : kNpyTypes) {
      if (type.descr == descr) return type;
    }
    throw InputError(fmt::format("{}: its numbers are of type {}; {}", place_, Quoted(descr), kKnownDescr));
  }
  std::vector<size_t> ParseShape() {
    std::vector<size_t> shape;
    Need('(');
    while (!Take(')')) {
      if (shape.size() == NpzFile::kMaxDimensions)
        throw InputError(fmt::format("{}: {} dimensions are allowed", place_, NpzFile::kMaxDimensions));
      shape.push_back(ParseLength());
      if (Take(',')) continue;
      Need(')');
      break;
    }
    return shape;
  }
  size_t ParseLength() {
    SkipBlanks();
    size_t length = 0, num_digits = 0;
    for (; !text_.empty() && std::isdigit(static_cast<unsigned char>(text_.front()));
         text_.remove_prefix(1)) {
      length = 10 * length + static_cast<size_t>(text_.front() - '0');
      if (++num_digits > 18) Fail();
    }
    if (num_digits == 0) Fail();
    return length;
  }

  std::string_view text_;
  const std::string& place_;
};

std::uint64_t NpyBits(std::string_view bytes) {
  std::uint64_t bits = 0;
  for (size_t i = bytes.size(); i-- > 0;) bits = bits << 8 | static_cast<unsigned char>(bytes[i]);
  return bits;
}

// IEEE 754 binary16: a sign, 5 bits of exponent with bias 15, 10 of fraction.
double HalfNumber(std::uint64_t bits) {
  const int exponent = static_cast<int>(bits >> 10 & 0x1f);
  const auto fraction = static_cast<double>(bits & 0x3ff);
  double size = 0.0;
  if (exponent == 0x1f) {
    size =
        fraction == 0.0 ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
  } else {
    size = exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024.0 + fraction, exponent - 25);
  }
  return (bits & 0x8000) != 0 ? -size : size;
}

double NpyNumber(std::string_view bytes, bool is_whole) {
  const std::uint64_t bits = NpyBits(bytes);
  if (bytes.size() == 2) return HalfNumber(bits);
  if (bytes.size() == 4) {
    const auto word = static_cast<std::uint32_t>(bits);
    return is_whole ? static_cast<double>(static_cast<std::int32_t>(word)) : std::bit_cast<float>(word);
  }
  return is_whole ? static_cast<double>(static_cast<std::int64_t>(bits)) : std::bit_cast<double>(bits);
}

}  // namespace

NpzArray ParseNpy(std::string_view bytes, const std::string& place) {
  const size_t version_at = kNpyMagic.size(), length_at = version_at + 2;
  if (!bytes.starts_with(kNpyMagic) || bytes.size() < length_at + 4)
    throw InputError(place + ": is no .npy file, or is cut off");
  const int major = bytes[version_at], minor = bytes[version_at + 1];
  if ((major != 1 && major != 2) || minor != 0)
    throw InputError(
        fmt::format("{}: is of version {}.{} of the format; 1.0 and 2.0 are allowed", place, major, minor));
  const size_t length_bytes = major == 1 ? 2 : 4, header_at = length_at + length_bytes;
  const size_t header_bytes = NpyBits(bytes.substr(length_at, length_bytes));
  if (header_bytes > bytes.size() - header_at) throw InputError(place + ": its header is cut off");
  const NpyHeader header = NpyHeaderParser(bytes.substr(header_at, header_bytes), place).Parse();
  NpzArray array;
  array.shape = *header.shape;
  array.is_whole = header.type->is_whole;
  if (*header.is_fortran_order)
    throw InputError(place + ": is in Fortran order; save numpy.ascontiguousarray of it");
  const std::string_view data = bytes.substr(header_at + header_bytes);
  const size_t most = data.size() / header.type->num_bytes;
  size_t count = 1;
  bool is_empty = false, is_too_large = false;
  for (const size_t length : array.shape) {
    is_empty = is_empty || length == 0;
    is_too_large = is_too_large || (length > 0 && count > most / length);
    if (length > 0 && !is_too_large) count *= length;
  }
  if (is_empty) count = 0;
  if ((is_too_large && !is_empty) || count * header.type->num_bytes != data.size())
    throw InputError(fmt::format("{}: its shape {} is of another size than its {} bytes of {}", place,
                                 FormatShape(array.shape), data.size(), header.type->descr));
  array.values.reserve(count);
  for (size_t i = 0; i < count; ++i)
    array.values.push_back(
        NpyNumber(data.substr(i * header.type->num_bytes, header.type->num_bytes), array.is_whole));
  return array;
}

}  // namespace rcme
