// How many trials a check may take, by what a trial costs.
#pragma once

#include "experiments/claims/claim.h"

namespace rcme {

inline constexpr TrialLimits kMicroseconds{4'000, 60'000, 400'000};  // one sample and its statistic
inline constexpr TrialLimits kMilliseconds{1'000, 4'000, 60'000};    // two hundred matches scored
inline constexpr TrialLimits kEstimatorCalls{600, 600, 10'000};      // one to three calls on 200 matches
inline constexpr TrialLimits kManyEstimatorCalls{400, 400, 5'000};  // more of them

}  // namespace rcme
