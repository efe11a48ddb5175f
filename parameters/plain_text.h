// Text that a terminal, a table and a JSON file can take: UTF-8 without control characters.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace rcme {

// How many bytes the UTF-8 character at the beginning of `text` has, which is not empty; 0 if it is not valid
// UTF-8 (RFC 3629).
size_t Utf8Length(std::string_view text);

// Where `text` stops being plain: at a byte that is not UTF-8, or at a control character other than tab and
// line end. Characters that turn the direction of writing count as such: with them a text looks like another.
// npos: nowhere.
size_t FindNotPlain(std::string_view text);

// The same of text for one line, such as a name in a table: a tab and a line end are not plain there.
size_t FindNotInLine(std::string_view text);

// `text` with escapes in place of line ends and of what is not plain (a line end becomes a backslash and n);
// where it has more than `max_bytes` the middle gives way to "[... 1234 bytes ...]".
std::string Printable(std::string_view text, size_t max_bytes = 4000);

// A value of the user's as messages quote it.
std::string Quoted(std::string_view value);

}  // namespace rcme
