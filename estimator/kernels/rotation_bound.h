// An upper bound of the number of matches that a rotation without a translation explains, whatever the
// rotation.
//
// A rotation preserves the distances between unit vectors. If it explains a match, d2 = e' C^-1 e <= c
// (refinement/rotation_equations.h), there is noise d1, d2 in units of sigma with |d1|^2 + |d2|^2 <= c that
// makes the residual zero. The unit vectors u1 and u2 of the match's rays then satisfy
//
//   |R u1 - u2| <= 1.1 s (|d1| + |d2|) <= tau = 1.1 s sqrt(2 c),   s = sigma / the least focal length.
//
// This holds to first order in the noise. The noisy direction is (1 - d1z / z) y + d1, where y = R ray1 with
// depth z. The factor 1.1 suffices if d1z is at most a twelfth of z. This excludes points that a rotation
// moves nearly 90 degrees out of the image, where a fit to matches in both images does not lead. So two
// matches i and j with
//
//   | |u1i - u1j| - |u2i - u2j| | > 2 tau
//
// are not both explained. The matches are divided into groups of eight. At most k matches of a group are
// explained if no more than k of them have k - 1 partners that can be explained together with them.
#pragma once

#include "estimator/kernels/match_blocks.h"

namespace rcme {

// An upper bound of the number of matches that any rotation explains with this threshold (FindRotated).
int BoundRotated(const MatchBlocks& matches, double threshold);

}  // namespace rcme
