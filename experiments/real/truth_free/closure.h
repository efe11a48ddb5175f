// Motions around loops of images, held against their covariances.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "experiments/real/truth_free/loops.h"
#include "experiments/real/truth_free/pair_answers.h"
#include "stats/median_ratio.h"

namespace rcme {

// One step of a loop, from each image to the next; its answer has the status ok.
struct AnsweredStep {
  const NamedPair* pair;
  const MotionEstimate* estimate;
  bool is_forward = true;  // from the pair's image 1 to its image 2
  // Whose matches, of the same numbers, tell by equal coordinates which share a key point: the pair of a
  // twin, since each twin is moved to the geometry of its own pair; null: the pair's.
  const NamedPair* key_points = nullptr;
};
using AnsweredLoop = std::span<const AnsweredStep>;

// What is zero of exact motions, 3x1 or 1x1.
using LoopError = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
using LoopErrorOf = LoopError (*)(AnsweredLoop);
// The rotation vector of M_n ... M_2 M_1, M_k the rotation of step k (R forward, R' backward), rad, in the
// first image's frame.
LoopError RotationClosure(AnsweredLoop loop);
// Of three images: the triple product of the three directions between their centres, which lie in a plane:
// the first two steps' seen from the first image by way of M_1, the last one's as its own pair has it. Of
// more images any directions can be sides of a polygon.
LoopError DirectionClosure(AnsweredLoop triple);

// Whether Sigma knows that key points are shared by the pairs of a loop.
enum class SharedErrors { kAllowedFor, kIgnored };

// (c - c_0)' Sigma^-1 (c - c_0), chi-square with as many degrees of freedom as c has coordinates. To first
// order dc = sum G_k q_k, q_k (5x1) the errors of motion k, G_k = dc/dq_k by differences, so that Sigma is
// Sigma_0 = sum G_k C_k G_k' where pairs are independent. They are not: a key point's error is in every match
// of it. The moves of c that the residuals of single matches make, G_k A^-1 J' r / (1 - h), have the outer
// products V_i, match by match, and V_c, summed first over the matches that share key points; Sigma = L_0
// (L_i^-1 V_c L_i^-T) L_0', L_0 and L_i the roots of Sigma_0 and V_i. Where they are ignored it is
// Sigma_0. Nothing where a matrix is not positive definite. `expected` is c_0: zero, or, of a twin, what its
// truth closes to.
std::optional<double> NormalizedClosure(AnsweredLoop loop, LoopErrorOf error_of, const LoopError& expected,
                                        SharedErrors shared = SharedErrors::kAllowedFor);

// Of each loop whose pairs are answered: the value above, and those of its twins. A pair that is in several
// loops makes these dependent. Matches of twins share a key point where those of their pairs do. Directions:
// of the loops of three images.
std::vector<UnitValues> ComputeClosures(const std::vector<PairAnswers>& answers,
                                        const std::vector<Loop>& loops, LoopErrorOf error_of,
                                        SharedErrors shared = SharedErrors::kAllowedFor);

}  // namespace rcme
