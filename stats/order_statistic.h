// Quantiles of a list, without sorting all of it.
#pragma once

#include <cstddef>
#include <vector>

namespace rcme {

// The value that has `rank` values before it in rising order, rank < number of values. The values are
// reordered: it stands at its place, smaller ones before it.
double ValueOfRank(std::size_t rank, std::vector<double>* values);

// The value of rank floor(probability (n - 1)) of n. NaN if there are no values.
double ComputeQuantile(std::vector<double>& values, double probability);

}  // namespace rcme
