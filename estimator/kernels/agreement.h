// Which matches agree with a refined motion, and which side of the cameras they lie on. The same decisions as
// refinement/fit_set.h and geometry/triangulation.h, many matches at a time.
#pragma once

#include "estimator/geometry/essential_matrix.h"
#include "estimator/kernels/match_blocks.h"
#include "estimator/kernels/score.h"

namespace rcme {

// Bounds of a match's residual and leverage.
struct AgreementBounds {
  double squared_distance;  // d2 <= this
  double leverage;          // variance that the motion adds, in units of sigma^2, <= this
};

// The matches with g^2 <= squared_distance * (n2 - v) where fitted, (n2 + v) elsewhere, v the variance that
// the motion adds to g, n2 times the square of the match's noise_scale; leverage v / n2 within its bound; and
// not clearly behind a camera.
void FindAgreeing(const MatchBlocks& matches, const RelativePose& pose, const double* F,
                  const VariancePolynomial& variance, const MatchMask& fitted, const AgreementBounds& bounds,
                  MatchMask* agreeing);

// Matches of the mask in front of both cameras, for the pose and for the one with -t.
struct FrontCounts {
  int with_t, with_opposite_t;
};
FrontCounts CountInFront(const MatchBlocks& matches, const MatchMask& mask, const RelativePose& pose);

// The first of {R_a, R_b} x {t, -t} that sees most of the matches in front of both cameras.
RelativePose SelectPoseByCheirality(const MatchBlocks& matches, const MatchMask& mask,
                                    const EssentialProjection& projection);

}  // namespace rcme
