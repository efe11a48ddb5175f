// The lines of a text from outside, one at a time. Memory does not grow with the text, and neither a line
// without an end nor a text without one is followed far.
//
// std::getline would take a failed allocation, and a failed read, for the end of the text: both set badbit in
// place of the exception. Here both are thrown on.
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
  // Reads up to `size` bytes into `buffer` and returns how many, 0 at the end; throws what keeps it from
  // reading.
  using Source = std::function<size_t(char* buffer, size_t size)>;

  // `name`: what messages call the text.
  TextLines(std::string name, Source source, const TextLimits& limits);

  // The next line without its end, valid until the next call; false after the last one. Throws InputError
  // where a limit is exceeded.
  bool Next(std::string_view* line);
  // InputError that names the text and the line that Next gave last.
  [[noreturn]] void Fail(const std::string& what) const;
  int line_number() const { return line_number_; }  // from 1

 private:
  bool Fill();  // the buffer, where it is empty; false at the end

  const std::string name_;
  const Source source_;
  const TextLimits limits_;
  std::string buffer_, line_;
  size_t begin_ = 0, end_ = 0;  // of what the buffer holds that no line has yet
  int line_number_ = 0;
  size_t num_bytes_ = 0;
};

// Of a text in memory, which has to outlive it.
TextLines::Source ReadFrom(std::string_view text);

// The parts of a text between separators; an empty last one does not count, so that "a,b," has two.
std::vector<std::string> SplitText(std::string_view text, char separator);

}  // namespace rcme
