// The number of paired trials needed to distinguish two methods.
#pragma once

#include <cstdint>

namespace rcme {

// The number of trials after which McNemar's two-sided test at level `significance` detects a difference with
// probability `power`. In a share `first_only` of the trials the event happens to the first method alone, in
// `second_only` to the second alone (Connor 1987, Biometrics 43:207, in the form of Lachin 1992):
//   n = (z_(1-a/2) sqrt(s) + z_power sqrt(s - d^2))^2 / d^2,  s = first_only + second_only,
//   d = first_only - second_only.
// The largest integer of the type if both are equal. Throws std::invalid_argument for invalid shares.
std::int64_t TrialsToTellApart(double first_only, double second_only, double significance = 0.05,
                               double power = 0.8);

}  // namespace rcme
