// A displacement that all images of a camera share and no motion explains, such as remaining lens distortion.
#pragma once

#include <cstdint>
#include <vector>

#include "experiments/data/camera_noise.h"
#include "experiments/real/camera_noise/fitted_pairs.h"

namespace rcme {

// Key points are observed at x + d(x), with d bilinear between the centres of 6x4 cells and the same in both
// images. To first order r = D theta + P q + noise. Here theta holds d at the cells, D = u_1' w(x_1) + u_2'
// w(x_2) with u the normals of the epipolar lines and w the bilinear weights, and P is the derivative by the
// motion. Each pair has the score s = D' (I - P (P' P)^-1 P') r / v, v its variance, and the information A
// likewise. If theta has the mean square tau^2, then
//
//   Q = sum over pairs (u, v) without a common image of s_u' s_v,   E Q = tau^2 sum tr(A_u A_v)
//
// and E Q = 0 without a displacement, however errors are correlated within a pair. Q is the locally best test
// of tau^2 = 0 that uses pairs as units. Its null distribution comes from 9,999 random sign changes of whole
// pairs, since a pair's residuals are equally likely with all signs reversed. theta is the best linear
// prediction (sum A + phi / tau^2)^-1 sum s, where phi >= 1 is the scatter of the scores over that which A
// implies. There are no cells if tau^2 <= 0. rms_px is tau. p_value is NaN with fewer than five pairs.
DisplacementCells FitSystematicDisplacement(const std::vector<FittedPair>& pairs, const Camera& camera,
                                            std::uint64_t seed);

// d at a point of an image.
Eigen::Vector2d DisplacementAt(const DisplacementCells& cells, const Camera& camera,
                               const Eigen::Vector2d& x_px);

}  // namespace rcme
