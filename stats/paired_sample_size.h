// How many paired trials tell two methods apart.
#pragma once

#include <cstdint>

namespace rcme {

// The trials after which McNemar's two-sided test at level `significance` finds a difference with probability
// `power`, where in a share `first_only` of the trials the event happens to the first alone and in
// `second_only` to the second alone (Connor 1987, Biometrics 43:207, as Lachin 1992 writes it):
//   n = (z_(1-a/2) sqrt(s) + z_power sqrt(s - d^2))^2 / d^2,  s = first_only + second_only, d their
//   difference.
// The greatest number of the type where both are equal. Throws std::invalid_argument for shares that are
// none.
std::int64_t TrialsToTellApart(double first_only, double second_only, double significance = 0.05,
                               double power = 0.8);

}  // namespace rcme
