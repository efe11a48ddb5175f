#pragma once

#include <vector>

namespace rcme {

// The median absolute deviation from the median, median_i |x_i - median_k x_k| (Hampel 1974). Of an even
// number of values the median is the mean of the middle two. NaN if there are no values.
double MedianDeviation(const std::vector<double>& values);

}  // namespace rcme
