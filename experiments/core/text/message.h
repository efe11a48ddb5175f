// Messages for people on standard error. If one cannot be written it is lost; no work ends because of it.
#pragma once

#include <fmt/format.h>

#include <string>

namespace rcme {

void WriteMessage(const std::string& text);

// As fmt::print to standard error, which throws where the stream is full or closed.
template <typename... Args>
void PrintMessage(fmt::format_string<Args...> format, Args&&... args) {
  WriteMessage(fmt::format(format, std::forward<Args>(args)...));
}

// Standard streams that the program was started without are opened on /dev/null, not to be written: else the
// next file opened, a result perhaps, would take their place and the messages.
void HoldStandardStreams();

}  // namespace rcme
