// How many matches a rotation without a translation can explain at most, whatever the rotation.
//
// A rotation keeps the distances between unit vectors. A match that it explains, d2 = e' C^-1 e <= c
// (refinement/rotation_equations.h), has noise d1, d2 in units of sigma with |d1|^2 + |d2|^2 <= c that makes
// its residual zero: the unit vectors u1 and u2 of its rays then fulfil
//
//   |R u1 - u2| <= 1.1 s (|d1| + |d2|) <= tau = 1.1 s sqrt(2 c),   s = sigma / the least focal length.
//
// (d2 is of first order. The direction that it reaches is (1 - d1z / z) y + d1, y = R ray1 with depth z; the
// factor 1.1 holds as long as d1z is at most a twelfth of z, which leaves out points that a rotation takes
// nearly 90 degrees out of the image. A fit to matches in both images does not go there.) So two matches i
// and j with
//
//   | |u1i - u1j| - |u2i - u2j| | > 2 tau
//
// are not both explained. The matches are taken in groups of eight. Of a group at most k are explained where
// no more than k have k - 1 partners with which they can be.
#pragma once

#include "estimator/kernels/match_blocks.h"

namespace rcme {

// At least the number of matches that any rotation explains with this threshold (FindRotated).
int BoundRotated(const MatchBlocks& matches, double threshold);

}  // namespace rcme
