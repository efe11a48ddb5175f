// Rotations around three images, held against their covariances.
#pragma once

#include <optional>
#include <vector>

#include "estimator/motion_estimate.h"
#include "experiments/truth_free/pair_set.h"

namespace rcme {

// Numbers of the pairs (a, b), (b, c) and (a, c) of three images of a set.
struct Triple {
  size_t ab = 0, bc = 0, ac = 0;
};
std::vector<Triple> FindTriples(const std::vector<NamedPair>& pairs);

// One pair of a triple with its answer (status ok).
struct AnsweredPair {
  const NamedPair* pair;
  const MotionEstimate* estimate;
};

// The rotation vector of R_ac' R_bc R_ab, zero if the three were exact, rad, in camera a's frame.
Eigen::Vector3d ClosureOf(const MotionEstimate& ab, const MotionEstimate& bc, const MotionEstimate& ac);

// (c - c_0)' Sigma^-1 (c - c_0), chi-square with 3 degrees of freedom. With R <- Exp(w) R, to first order
//
//   dc = R_ab' w_ab + R_ac' (w_bc - w_ac),
//
// so that Sigma is the sum Sigma_0 of the three covariances so turned where pairs are independent. They are
// not: a key point's error is in every match of it. The moves of the closure that the residuals of single
// matches make, A^-1 J' r / (1 - h) so turned, have the outer products V_i, match by match, and V_c, summed
// first over the matches that share key points; Sigma = L_0 (L_i^-1 V_c L_i^-T) L_0', L_0 and L_i the roots
// of Sigma_0 and V_i. Nothing where either is not positive definite. `expected` is c_0: zero, or, of a twin,
// what its truth closes to.
std::optional<double> NormalizedClosure(const AnsweredPair& ab, const AnsweredPair& bc,
                                        const AnsweredPair& ac, const Eigen::Vector3d& expected);

}  // namespace rcme
