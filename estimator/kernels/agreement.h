// Finds the matches that agree with a refined motion, and the side of the cameras on which they lie. Makes
// the same decisions as refinement/fit_set.h and geometry/triangulation.h, for many matches at a time.
#pragma once

#include "estimator/geometry/essential_matrix.h"
#include "estimator/kernels/match_blocks.h"
#include "estimator/kernels/score.h"

namespace rcme {

// Upper bounds of a match's residual and leverage.
struct AgreementBounds {
  double squared_distance;  // of d2
  double leverage;          // of the variance that the motion adds, in units of sigma^2
};

// Finds the matches that meet three conditions:
// - g^2 <= squared_distance * (n2 - v) if fitted, g^2 <= squared_distance * (n2 + v) if not. v is the
//   variance that the motion adds to g; n2 includes the square of the match's noise_scale.
// - The leverage v / n2 is within its bound.
// - The match is not clearly behind a camera.
void FindAgreeing(const MatchBlocks& matches, const RelativePose& pose, const double* F,
                  const VariancePolynomial& variance, const MatchMask& fitted, const AgreementBounds& bounds,
                  MatchMask* agreeing);

// Numbers of matches of the mask in front of both cameras, for the pose and for the pose with -t.
struct FrontCounts {
  int with_t, with_opposite_t;
};
FrontCounts CountInFront(const MatchBlocks& matches, const MatchMask& mask, const RelativePose& pose);

// The pose of {R_a, R_b} x {t, -t} that puts the most matches in front of both cameras; the first one of
// equals.
RelativePose SelectPoseByCheirality(const MatchBlocks& matches, const MatchMask& mask,
                                    const EssentialProjection& projection);

}  // namespace rcme
