// Bounds that hold for the next observation whatever the law: split conformal prediction.
//
// Scores s_1, ..., s_n and that of the next observation are exchangeable. The k-th smallest of the n, k =
// ceil((n + 1) level), is at least the next score with probability at least `level` (Vovk, Gammerman & Shafer
// 2005; Lei et al. 2018), and at most level + 1 / (n + 1) where no two are equal.
//
// Observations of one group (the image pairs of a scene) depend on each other; the groups, and the next one,
// are exchangeable. Each of the G groups then has the weight 1 / (G + 1), divided evenly among its scores,
// and the next group 1 / (G + 1) at infinity: the quantile of this law is at least the score of a random
// observation of the next group with probability at least `level` (Lee, Barber & Willett 2023, "HCP"). With a
// score in each group this is the rule above.
#pragma once

#include <cstdint>
#include <span>

namespace rcme {

// The bound. Infinite where there are too few groups, and where a score that it would be is. Scores are not
// NaN. Throws std::invalid_argument unless there are as many groups as scores and level is in (0, 1).
double ConformalBound(std::span<const double> scores, std::span<const std::int64_t> groups, double level);

// The fewest groups of which the bound can be finite: the least G with level <= G / (G + 1).
std::int64_t FewestGroupsForBound(double level);

// P(a score at least as great as `score`) for an observation exchangeable with the sorted, rising
// `reference`: (1 + #{reference >= score}) / (n + 1). At most a with probability at most a.
double ConformalPValue(std::span<const double> reference, double score);

}  // namespace rcme
