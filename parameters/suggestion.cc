#include "parameters/suggestion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numeric>

#include "parameters/plain_text.h"

namespace rcme {
namespace {

constexpr size_t kMostLetters = 100;  // longer words are not treated as misspellings
constexpr size_t kLeastPrefix = 3, kLeastPart = 4;

std::string Folded(std::string_view word) {
  std::string folded(word);
  for (char& c : folded) c = c == '-' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return folded;
}

// The only name that begins with the word; empty if there are none or several.
std::string OnlyContinuation(const std::string& word, const std::vector<std::string>& names) {
  if (word.size() < kLeastPrefix) return {};
  std::string only;
  for (const std::string& name : names) {
    if (!Folded(name).starts_with(word)) continue;
    if (!only.empty()) return {};
    only = name;
  }
  return only;
}

// The shortest name that has the word between underscores; empty if there is none.
std::string ShortestWithPart(const std::string& word, const std::vector<std::string>& names) {
  if (word.size() < kLeastPart) return {};
  const std::string part = fmt::format("_{}_", word);
  std::string shortest;
  for (const std::string& name : names) {
    const bool has_it = fmt::format("_{}_", Folded(name)).find(part) != std::string::npos;
    if (has_it && (shortest.empty() || name.size() < shortest.size())) shortest = name;
  }
  return shortest;
}

}  // namespace

size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> before_last, last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t replaced = last[j - 1] + (a[i - 1] != b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
      const bool is_swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (is_swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    before_last = last;
    last = row;
  }
  return last[b.size()];
}

std::string DidYouMean(std::string_view given, const std::vector<std::string>& names) {
  if (given.empty() || given.size() > kMostLetters) return {};
  const std::string word = Folded(given);
  std::string nearest = OnlyContinuation(word, names);
  size_t least = nearest.empty() ? 2 + word.size() / 4 : 0;
  for (const std::string& name : names) {
    const size_t distance = EditDistance(word, Folded(name));
    if (distance >= least || distance >= std::max(word.size(), name.size())) continue;
    least = distance;
    nearest = name;
  }
  // A whole part of a name is nearer than two slips: `magsac` is opencv_magsac, not msac.
  if (nearest.empty() || least > 1) {
    if (const std::string whole = ShortestWithPart(word, names); !whole.empty()) nearest = whole;
  }
  return nearest.empty() ? "" : " (did you mean " + Quoted(nearest) + "?)";
}

}  // namespace rcme
