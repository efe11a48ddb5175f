// The Pareto front of points in the plane; smaller is better in both coordinates.
#pragma once

#include <cstddef>
#include <vector>

namespace rcme {

// Points with equal first coordinates: kStay keeps each point unless a point with a smaller first coordinate
// has a second one at most as large (the weak front); kLeastSecondStays keeps only those with the least
// second coordinate.
enum class TiesOfFirst { kStay, kLeastSecondStays };

// Indices of the points on the front, by ascending first coordinate. Equal points are all on it or none.
// Throws std::invalid_argument for lists of different length or a NaN.
std::vector<size_t> ParetoFront(const std::vector<double>& first, const std::vector<double>& second,
                                TiesOfFirst ties);

}  // namespace rcme
