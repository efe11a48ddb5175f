// Sums of the mixture likelihood of a motion (calibrated/mixture_parameters.h) and of its derivatives over
// matches, many at a time. The scalar twin is calibrated/match_terms.h.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "estimator/calibrated/mixture_parameters.h"
#include "estimator/geometry/pose.h"
#include "estimator/kernels/match_blocks.h"
#include "estimator/kernels/two_view_pose.h"

namespace rcme {

// Sums over the matches of the mask. With noise scales, r and log_likelihood are those of r' of
// calibrated/mixture_parameters.h, but num_wrong_near counts by r itself. p is the probability that a match
// is an inlier, v = 2k / (2k - 1 + u^2) the weight of its residual u = r / s, and psi = v u:
struct MixtureSums {
  double log_likelihood = 0.0;           // of the densities per unit of the assumed sigma
  double num_right = 0.0;                // sum p
  double sum_squares = 0.0;              // sum p v r^2
  double num_wrong_near = 0.0;           // sum of 1 - p over matches with |r| <= kNearResidual
  Vector5d gradient = Vector5d::Zero();  // of -log_likelihood in the motion's tangent; c(z) held fixed
  // sum max(p psi' - p (1 - p) psi^2, 0.6 p v) r_p' r_p / s^2: the Hessian, kept positive.
  Matrix5d hessian = Matrix5d::Zero();
};
inline constexpr double kNearResidual = 30.0;  // units of the assumed sigma

MixtureSums SumMixture(const MatchBlocks& matches, const MatchMask& mask, const RelativePose& pose,
                       const MixtureParameters& parameters);
// Its gradient alone and its log_likelihood alone, with the same bits in less time.
Vector5d SumMixtureGradient(const MatchBlocks& matches, const MatchMask& mask, const RelativePose& pose,
                            const MixtureParameters& parameters);
double SumLogLikelihood(const MatchBlocks& matches, const MatchMask& mask, const RelativePose& pose,
                        const MixtureParameters& parameters);

// For every match at a motion: r, z and the derivatives of r along the five tangent coordinates; with noise
// scales, those of r' and z' (calibrated/match_terms.h). Each list is padded to a whole block.
struct MatchTermLists {
  std::vector<double> residual, depth;
  std::array<std::vector<double>, 5> derivative;
};
// Of the first `most_matches` matches, or of all.
void EvaluateTerms(const MatchBlocks& matches, const RelativePose& pose, MatchTermLists* terms,
                   int most_matches = std::numeric_limits<int>::max());

// How clearly the matches of the first `num_blocks` blocks lie in front of the cameras: sum v
// z / sqrt(1 + z^2), v = 1 / (1 + r^2 / s^2). Here z is the mean over both cameras, whose sign changes with
// that of t.
double SumCheirality(const MatchBlocks& matches, int num_blocks, const RelativePose& pose, double scale);

}  // namespace rcme
