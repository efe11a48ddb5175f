// Reads an untrusted text line by line. Memory does not grow with the text, and reading stops at a line or
// text that exceeds its limit.
//
// std::getline treats a failed allocation or read as the end of the text: both set badbit and hide the
// exception. Here both are rethrown.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace rcme {

struct TextLimits {
  size_t line_bytes = 0, text_bytes = 0;
};

class TextLines {
 public:
  // Reads up to `size` bytes into `buffer` and returns their number, 0 at the end; throws if reading fails.
  using Source = std::function<size_t(char* buffer, size_t size)>;

  // `name`: the name of the text in messages.
  TextLines(std::string name, Source source, const TextLimits& limits);

  // Gets the next line without its line end, valid until the next call; false after the last line. Throws
  // InputError if a limit is exceeded.
  bool Next(std::string_view* line);
  // Throws InputError that names the text and the last line returned by Next.
  [[noreturn]] void Fail(const std::string& what) const;

 private:
  bool Fill();  // fills the buffer if it is empty; false at the end

  const std::string name_;
  const Source source_;
  const TextLimits limits_;
  std::string buffer_, line_;
  size_t begin_ = 0, end_ = 0;  // the part of the buffer not yet returned
  int line_number_ = 0;
  size_t num_bytes_ = 0;
};

// Source of a text in memory, which must outlive it.
TextLines::Source ReadFrom(std::string_view text);

// The parts of a text between separators; an empty last part is dropped, so "a,b," has two.
std::vector<std::string> SplitText(std::string_view text, char separator);

}  // namespace rcme
