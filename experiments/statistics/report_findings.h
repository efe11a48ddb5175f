#pragma once

#include <string>
#include <vector>

#include "experiments/statistics/compare.h"
#include "experiments/statistics/summarize.h"

namespace rcme {

// What a run shows, a sentence each: the range of each estimator's failure rate with its 95 % intervals and
// the conditions at its ends; then of each, on the same trials, in how many conditions it fails and refuses
// more or less often than the reference (Holm-adjusted McNemar p below 0.05). Nothing is said of what has no
// trials or no partner.
std::vector<std::string> FindingsOf(const Summary& summary, const Comparison& comparison);

}  // namespace rcme
