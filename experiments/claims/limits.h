// How many trials a check may take, by what a trial costs.
#pragma once

#include "experiments/claims/claim.h"

namespace rcme {

inline constexpr TrialLimits kMicroseconds{4'000, 60'000, 400'000};  // one sample and its statistic
inline constexpr TrialLimits kMilliseconds{1'000, 8'000, 60'000};    // a hundred points, a refinement
inline constexpr TrialLimits kEstimatorCalls{300, 1'000, 10'000};    // several calls on 200 matches

}  // namespace rcme
