// Messages for people on standard error. A message that cannot be written is lost; the program goes on.
#pragma once

#include <fmt/format.h>

#include <string>

namespace rcme {

void WriteMessage(const std::string& text);

// Like fmt::print to standard error, which, however, throws if the stream is full or closed.
template <typename... Args>
void PrintMessage(fmt::format_string<Args...> format, Args&&... args) {
  WriteMessage(fmt::format(format, std::forward<Args>(args)...));
}

// Opens missing standard streams on /dev/null. Otherwise the next opened file, perhaps a result, would get
// the number of a standard stream, and messages would be written into it.
void HoldStandardStreams();

}  // namespace rcme
