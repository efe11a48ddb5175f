// Suggestions for misspelt names: the known name nearest to the given one.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace rcme {

// The number of letters to insert, delete, replace or swap with their neighbour to turn one word into the
// other (Damerau 1964; no letter is edited twice).
size_t EditDistance(std::string_view a, std::string_view b);

// " (did you mean 'x'?)" with the nearest name, if its distance is at most 1 + a quarter of the letters, or
// if it is the only name with this prefix. Else with the shortest name that has the word, of at least four
// letters, between underscores ("magsac": "opencv_magsac"). Case, - and _ are ignored. Otherwise empty.
std::string DidYouMean(std::string_view given, const std::vector<std::string>& names);

// The member `name` of each entry.
template <typename Entries>
std::vector<std::string> ListNames(const Entries& entries) {
  std::vector<std::string> names;
  for (const auto& entry : entries) names.emplace_back(entry.name);
  return names;
}

}  // namespace rcme
