#pragma once

#include <vector>

namespace rcme {

// Holm's (1979) step-down adjusted p-values, in the order given: of the p-values in rising order,
// max_(j <= i) min(1, (m - j + 1) p_(j)). Rejecting where the adjusted value is <= alpha makes one false
// rejection or more with probability at most alpha, however the m tests depend on each other. Throws
// std::invalid_argument on a p-value outside [0, 1] or NaN.
std::vector<double> HolmAdjusted(const std::vector<double>& p_values);

}  // namespace rcme
