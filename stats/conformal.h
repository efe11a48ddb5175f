// Bounds that hold for the next observation whatever the law: split conformal prediction.
//
// Scores s_1, ..., s_n and that of the next observation are exchangeable. The k-th smallest of the n, k =
// ceil((n + 1) level), is at least the next score with probability at least `level` (Vovk, Gammerman & Shafer
// 2005; Lei et al. 2018), and at most level + 1 / (n + 1) where no two are equal.
//
// Observations of one group (the image pairs of a scene) depend on each other; the G groups, and the next
// one, are exchangeable. A problem of the next group is one of its N at random, and only some give a score
// (others are refused, or of another stratum). With a = 1 - level, a group loses
//   L_g(q) = (1 / N_g) sum over its scores of ([s > q] - a),   -a <= L_g <= 1 - a,
// which falls with q, and the least q with sum_g L_g(q) + (1 - a) <= 0 has E L_next(q) <= 0 (conformal risk
// control, Angelopoulos et al. 2024, theorem 1): of the problems that give a score at most the share a lies
// beyond q. With one problem in each group this is the rule above.
#pragma once

#include <cstdint>
#include <span>

namespace rcme {

// The bound. `shares`: of each score 1 / N, N the problems of its group, also those that give no score; 1
// where observations are independent. Infinite where there are too few, and where a score that it would be
// is. Scores are not NaN. Throws std::invalid_argument unless there are as many shares as scores, all in (0,
// 1], and level is in (0, 1).
double ConformalBound(std::span<const double> scores, std::span<const double> shares, double level);

// The fewest groups of which the bound can be finite: the least G with level <= G / (G + 1).
std::int64_t FewestGroupsForBound(double level);

// P(a score at least as great as `score`) for an observation exchangeable with the sorted, rising
// `reference`: (1 + #{reference >= score}) / (n + 1). At most a with probability at most a.
double ConformalPValue(std::span<const double> reference, double score);

}  // namespace rcme
