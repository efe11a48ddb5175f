#pragma once

#include <vector>

namespace rcme {

// Holm's (1979) step-down adjusted p-values, in the given order: for the ascending p-values, max_(j <= i)
// min(1, (m - j + 1) p_(j)). Rejecting if the adjusted value is <= alpha makes one or more false rejections
// with probability at most alpha, whatever the dependence between the m tests. Throws std::invalid_argument
// for a p-value that is NaN or outside of [0, 1].
std::vector<double> HolmAdjusted(const std::vector<double>& p_values);

}  // namespace rcme
