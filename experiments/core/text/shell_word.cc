#include "experiments/core/text/shell_word.h"

#include <algorithm>
#include <string_view>

namespace rcme {
namespace {

bool IsPlain(char c) {
  constexpr std::string_view kUnquotedSigns = "_-+./,:=@%";
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         kUnquotedSigns.find(c) != std::string_view::npos;
}

}  // namespace

std::string QuoteForShell(const std::string& word) {
  if (!word.empty() && std::ranges::all_of(word, IsPlain)) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace rcme
