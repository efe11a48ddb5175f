// A displacement that all images of a camera share, beyond what a motion explains: what is left of its lens.
#pragma once

#include <cstdint>
#include <vector>

#include "estimator/motion_problem.h"
#include "experiments/data/camera_noise.h"
#include "experiments/real/camera_noise/fitted_pairs.h"

namespace rcme {

// Key points are observed at x + d(x), d bilinear between the centres of 6x4 cells and the same in both
// images. To first order r = D theta + P q + noise, theta the d of the cells, D = u_1' w(x_1) + u_2' w(x_2),
// u the normals of the epipolar lines and w the bilinear weights, P the derivatives along the motion. Each
// pair has the score s = D' (I - P (P' P)^-1 P') r / v, v its variance, and the information A likewise. With
// theta of mean square tau^2
//
//   Q = sum over pairs (u, v) without a common image of s_u' s_v,   E Q = tau^2 sum tr(A_u A_v)
//
// and E Q = 0 without it, whatever is correlated within a pair. Locally no test of tau^2 = 0 is better that
// knows pairs alone. Its law: pairs' signs drawn anew (the residuals of a pair are as likely with all signs
// turned), 9,999 times. theta is the best linear prediction (sum A + phi / tau^2)^-1 sum s, phi how much more
// scores scatter than A says; nil where tau^2 <= 0.
// rms_px is tau; p_value NaN with fewer than five pairs.
DisplacementCells FitSystematicDisplacement(const std::vector<FittedPair>& pairs, const Camera& camera,
                                            std::uint64_t seed);

// d at a point of an image.
Eigen::Vector2d DisplacementAt(const DisplacementCells& cells, const Camera& camera,
                               const Eigen::Vector2d& x_px);

}  // namespace rcme
