// Quantiles of a list without sorting it.
#pragma once

#include <cstddef>
#include <vector>

namespace rcme {

// The value at index `rank` in ascending order, rank < number of values. Reorders the values: this one is at
// its index, smaller ones before it.
double ValueOfRank(std::size_t rank, std::vector<double>* values);

// The value of rank floor(probability (n - 1)) of n. NaN if there are no values.
double ComputeQuantile(std::vector<double>& values, double probability);

}  // namespace rcme
