// Plain text, safe for a terminal, a table and a JSON file: UTF-8 without control characters.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace rcme {

// The length in bytes of the UTF-8 character at the beginning of `text`, which must not be empty; 0 if it is
// not valid UTF-8 (RFC 3629).
size_t Utf8Length(std::string_view text);

// The position where `text` stops being plain: the first byte that is not UTF-8, or the first control
// character other than tab and line end. Characters that change the writing direction count as control
// characters, since with them a text can look like another one. npos: the whole text is plain.
size_t FindNotPlain(std::string_view text);

// The same for a single line, such as a name in a table: tabs and line ends are not plain.
size_t FindNotInLine(std::string_view text);

// `text` with line ends and characters that are not plain escaped (a line end becomes a backslash and n). In
// texts longer than `max_bytes` the middle is replaced by "[... 1234 bytes ...]".
std::string Printable(std::string_view text, size_t max_bytes = 4000);

// A user's value as quoted in messages.
std::string Quoted(std::string_view value);

}  // namespace rcme
