// The points of a plane that none beats, where less is better in both coordinates.
#pragma once

#include <cstddef>
#include <vector>

namespace rcme {

// Of points with the same first coordinate: stay, whatever their second one is, as long as no point with a
// lower first coordinate has as low a second one (the weak front); or only those with the least second one.
enum class TiesOfFirst { kStay, kLeastSecondStays };

// Indices of the points on the front, by rising first coordinate. Points that are equal are all on it or
// none. Throws std::invalid_argument: as many of both are needed, and none may be NaN.
std::vector<size_t> ParetoFront(const std::vector<double>& first, const std::vector<double>& second,
                                TiesOfFirst ties);

}  // namespace rcme
