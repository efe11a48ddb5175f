// What somebody may have meant: of the names there are, the one nearest to what was written.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace rcme {

// How many letters have to be put in, left out, replaced or swapped with their neighbour to make one word of
// the other (Damerau 1964; no letter is touched twice).
size_t EditDistance(std::string_view a, std::string_view b);

// " (did you mean 'x'?)" with the nearest of the names, where one is near: at most 1 + a quarter of the
// letters away, or the only one that begins so. Upper and lower case, - and _ count as the same. Empty: none
// is near.
std::string DidYouMean(std::string_view given, const std::vector<std::string>& names);

}  // namespace rcme
