// Compares the closure errors of motions around loops of images with their covariances.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "experiments/real/truth_free/loops.h"
#include "experiments/real/truth_free/pair_set.h"
#include "stats/median_ratio.h"

namespace rcme {

// One step of a loop, from an image to the next one. Its estimate has the status ok.
struct AnsweredStep {
  const NamedPair* pair;
  const MotionEstimate* estimate;
  bool is_forward = true;  // from the pair's image 1 to its image 2
  // Matches share a key point if their coordinates in this pair are equal; null: in `pair`. For a twin this
  // is the real pair, with the same order of matches, since the twin's key points have been moved.
  const NamedPair* key_points = nullptr;
};
using AnsweredLoop = std::span<const AnsweredStep>;

// Closure error, zero for exact motions; 3x1 or 1x1.
using LoopError = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
using LoopErrorOf = LoopError (*)(AnsweredLoop);
// The rotation vector of M_n ... M_2 M_1, M_k the rotation of step k (R forward, R' backward), rad, in the
// first image's frame.
LoopError RotationClosure(AnsweredLoop loop);
// Triple product of the three translation directions among three images, which lie in a plane; all in the
// first image's frame (the second direction is rotated there by M_1). With more images any directions can be
// the sides of a polygon, so there is no such error.
LoopError DirectionClosure(AnsweredLoop triple);

// Whether Sigma accounts for key points that pairs of a loop share.
enum class SharedErrors { kAllowedFor, kIgnored };

// (c - c_0)' Sigma^-1 (c - c_0), chi-square with as many degrees of freedom as c has coordinates. `expected`
// is c_0: zero, or for a twin the closure error of its true motions.
//
// To first order dc = sum G_k q_k, with q_k (5x1) the error of motion k and G_k = dc/dq_k by differences. For
// independent pairs Sigma would be Sigma_0 = sum G_k C_k G_k', and kIgnored uses that. But pairs that share a
// key point share its error, and all share the calibration: C_k is without errors of it that nobody stated.
// The residual of one match moves c by G_k A^-1 J' r / (1 - h). V_i is the sum of the outer products of these
// moves; for V_c the moves of matches that share key points are added first. Then Sigma = L_0 (L_i^-1 V_c
// L_i^-T) L_0', with L_0 and L_i the Cholesky factors of Sigma_0 and V_i. nullopt: a matrix is not positive
// definite, or no match has a move.
std::optional<double> NormalizedClosure(AnsweredLoop loop, LoopErrorOf error_of, const LoopError& expected,
                                        SharedErrors shared = SharedErrors::kAllowedFor);

// NormalizedClosure of each loop whose pairs all have an estimate, and of its twins. Loops with a common pair
// are dependent. Matches of twins share a key point if those of their pairs do. With DirectionClosure only
// loops of three images count.
std::vector<UnitValues> ComputeClosures(const std::vector<PairAnswers>& answers,
                                        const std::vector<Loop>& loops, LoopErrorOf error_of,
                                        SharedErrors shared = SharedErrors::kAllowedFor);

}  // namespace rcme
