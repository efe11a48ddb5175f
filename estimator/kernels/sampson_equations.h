// The normal equations of the Sampson distance (refinement/sampson_equations.h), many matches at a time, in
// whitened coordinates.
#pragma once

#include "estimator/kernels/match_blocks.h"
#include "estimator/refinement/sampson_mle.h"

namespace rcme {

// The kernel's input: F and its derivatives along the five coordinates of the motion (whitened coordinates).
// And its output: sums, symmetric matrices as lower triangles row by row.
struct SampsonModel {
  double F[9], dF[5][9];
};
struct SampsonSums {
  double cost, gradient[5], hessian[15];
};

// The normal equations of sum rho(r^2) / 2 over the matches of the mask at a motion, r = g / |J| in units of
// a match's sigma. With J_k and g_k the derivatives of J and g along coordinate k of the motion,
// dr / dp_k = (g_k - r J'J_k / |J|) / |J|.
NormalEquations LinearizeSampson(const MatchBlocks& matches, const MatchMask& mask, const RelativePose& pose,
                                 Loss loss);

// sum g_p' g_p / var g over the matches of the mask.
Matrix5d SampsonInformation(const MatchBlocks& matches, const MatchMask& mask, const RelativePose& pose);

// The minimisation of refinement/sampson_mle.h with these equations.
RefinedMotion RefineBySampson(const MatchBlocks& matches, const MatchMask& mask, const RelativePose& start,
                              Loss loss);

}  // namespace rcme
