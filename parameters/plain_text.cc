#include "parameters/plain_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace rcme {
namespace {

constexpr size_t kMaxQuotedBytes = 200;

// C0 and DEL (one byte), and C1 (two bytes), which some terminals interpret as commands. Three bytes: U+2028
// to U+202E (line and paragraph separators, embeddings and overrides of the writing direction) and U+2066 to
// U+2069 (its isolates).
bool IsControl(std::string_view character) {
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(character[i]); };
  if (byte(0) < 0x20 || byte(0) == 0x7F) return true;
  if (byte(0) == 0xC2) return byte(1) < 0xA0;
  if (byte(0) != 0xE2) return false;
  return (byte(1) == 0x80 && byte(2) >= 0xA8 && byte(2) <= 0xAE) ||
         (byte(1) == 0x81 && byte(2) >= 0xA6 && byte(2) <= 0xA9);
}

// The start of the character that contains the byte `at`, so that a cut there belongs to the second part.
size_t CharacterStart(std::string_view text, size_t at) {
  while (at > 0 && at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80) --at;
  return at;
}

std::string WithoutMiddle(std::string_view text, size_t max_bytes) {
  if (text.size() <= max_bytes) return std::string(text);
  const size_t head = CharacterStart(text, max_bytes / 2);
  const size_t tail = CharacterStart(text, text.size() - max_bytes / 2);
  return fmt::format("{}[... {} bytes ...]{}", text.substr(0, head), tail - head, text.substr(tail));
}

}  // namespace

size_t Utf8Length(std::string_view text) {
  const auto byte = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  if (lead < 0xC2 || lead > 0xF4) return 0;
  const size_t length = lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
  // The second byte excludes overlong forms, surrogates and characters beyond U+10FFFF.
  const unsigned min = lead == 0xE0 ? 0xA0 : lead == 0xF0 ? 0x90 : 0x80;
  const unsigned max = lead == 0xED ? 0x9F : lead == 0xF4 ? 0x8F : 0xBF;
  if (byte(1) < min || byte(1) > max) return 0;
  for (size_t i = 2; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  return length;
}

size_t FindNotPlain(std::string_view text) {
  for (size_t at = 0; at < text.size();) {
    const size_t length = Utf8Length(text.substr(at));
    if (length == 0) return at;
    if (IsControl(text.substr(at)) && text[at] != '\t' && text[at] != '\n') return at;
    at += length;
  }
  return std::string_view::npos;
}

size_t FindNotInLine(std::string_view text) {
  return std::min(FindNotPlain(text), text.find_first_of("\t\n"));
}

std::string Printable(std::string_view text, size_t max_bytes) {
  const std::string shortened = WithoutMiddle(text, max_bytes);
  std::string printable;
  for (std::string_view rest = shortened; !rest.empty();) {
    const size_t length = Utf8Length(rest);
    if (rest.front() == '\n') {
      printable += "\\n";
    } else if (length == 0 || IsControl(rest)) {
      for (const char c : rest.substr(0, std::max<size_t>(length, 1)))
        printable += fmt::format("\\x{:02X}", static_cast<unsigned char>(c));
    } else {
      printable += rest.substr(0, length);
    }
    rest.remove_prefix(std::max<size_t>(length, 1));
  }
  return printable;
}

std::string Quoted(std::string_view value) { return fmt::format("'{}'", Printable(value, kMaxQuotedBytes)); }

}  // namespace rcme
