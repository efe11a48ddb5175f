#pragma once

#include <vector>

namespace rcme {

// Integers that sum to `total` and are as close as possible to total * shares[i] / sum(shares) (largest
// remainders; of equal ones the first). Shares must not be negative or all zero.
std::vector<int> SplitByShares(int total, const std::vector<double>& shares);

}  // namespace rcme
