// Bounds for the next observation, valid for any law: split conformal prediction.
//
// Scores s_1, ..., s_n and that of the next observation are exchangeable. The k-th smallest of the n, k =
// ceil((n + 1) level), is at least the next score with probability at least `level` (Vovk, Gammerman & Shafer
// 2005; Lei et al. 2018), and with at most level + 1 / (n + 1) if no two are equal.
//
// Observations of one group (the image pairs of a scene) depend on each other; the G groups and the next one
// are exchangeable. Consider a random one of the N problems of the next group. Only some problems give a
// score (others are refused, or belong to another stratum). With a = 1 - level, the loss of a group is
//   L_g(q) = (1 / N_g) sum over its scores of ([s > q] - a),   -a <= L_g <= 1 - a,
// which falls with q. The least q with sum_g L_g(q) + (1 - a) <= 0 has E L_next(q) <= 0 (conformal risk
// control, Angelopoulos et al. 2024, theorem 1): of the problems that give a score at most the share a
// exceeds q. With one problem per group this is the rule above.
#pragma once

#include <cstdint>
#include <span>

namespace rcme {

// The bound. `shares`: for each score 1 / N, N the number of problems in its group, including those without a
// score; 1 for independent observations. Infinite if there are too few scores, or if the bounding score is
// infinite. Scores must not be NaN. Throws std::invalid_argument unless there are as many shares as scores,
// all in (0, 1], and level is in (0, 1).
double ConformalBound(std::span<const double> scores, std::span<const double> shares, double level);

// The smallest number of groups for a finite bound: the least G with level <= G / (G + 1).
std::int64_t FewestGroupsForBound(double level);

// The conformal p-value P(a score >= `score`) of an observation exchangeable with the ascending `reference`:
// (1 + #{reference >= score}) / (n + 1). It is at most a with probability at most a.
double ConformalPValue(std::span<const double> reference, double score);

}  // namespace rcme
