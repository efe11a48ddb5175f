#include "parameters/text_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "parameters/input_error.h"

namespace rcme {
namespace {

constexpr size_t kBufferBytes = size_t{64} << 10;

}  // namespace

TextLines::TextLines(std::string name, Source source, const TextLimits& limits)
    : name_(std::move(name)), source_(std::move(source)), limits_(limits), buffer_(kBufferBytes, '\0') {}

bool TextLines::Fill() {
  if (begin_ == end_) {
    begin_ = 0;
    end_ = source_(buffer_.data(), buffer_.size());
  }
  return begin_ < end_;
}

bool TextLines::Next(std::string_view* line) {
  line_.clear();
  ++line_number_;
  bool has_end = false;
  while (!has_end && Fill()) {
    const std::string_view rest(buffer_.data() + begin_, end_ - begin_);
    const size_t length = std::min(rest.find('\n'), rest.size());
    has_end = length < rest.size();
    if (line_.size() + length > limits_.line_bytes)
      Fail(fmt::format("the line is too long; at most {} bytes are allowed", limits_.line_bytes));
    line_ += rest.substr(0, length);
    begin_ += length + (has_end ? 1 : 0);
  }
  num_bytes_ += line_.size() + 1;
  if (num_bytes_ > limits_.text_bytes)
    Fail(
        fmt::format("the text is too long; at most {} MiB, unpacked, are allowed", limits_.text_bytes >> 20));
  *line = line_;
  return has_end || !line_.empty();
}

void TextLines::Fail(const std::string& what) const {
  throw InputError(fmt::format("{}:{}: {}", name_, line_number_, what));
}

TextLines::Source ReadFrom(std::string_view text) {
  return [text](char* buffer, size_t size) mutable {
    const size_t num_copied = text.copy(buffer, size);
    text.remove_prefix(num_copied);
    return num_copied;
  };
}

std::vector<std::string> SplitText(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const size_t end = std::min(text.find(separator), text.size());
    parts.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

}  // namespace rcme
