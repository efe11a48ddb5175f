#pragma once

#include <vector>

namespace rcme {

// Whole numbers that sum to `total` and are as close to total * shares[i] / sum(shares) as whole numbers can
// be (largest remainders; of equal ones the first). Shares are not negative and not all zero.
std::vector<int> SplitByShares(int total, const std::vector<double>& shares);

}  // namespace rcme
