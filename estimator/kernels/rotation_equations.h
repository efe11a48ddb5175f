// The normal equations of a pure rotation (refinement/rotation_equations.h), many matches at a time, in
// whitened coordinates. There the residual e = x2 - h(x1) has covariance C = I + J J'.
#pragma once

#include "estimator/kernels/score.h"
#include "estimator/refinement/rotation_equations.h"

namespace rcme {

// Sums over the matches of the mask.
RotationEquations LinearizeRotation(const MatchBlocks& matches, const MatchMask& mask,
                                    const Eigen::Matrix3d& R, Loss loss);

// Finds the matches with d2 <= threshold that are in front of camera 2.
void ScanRotation(const MatchBlocks& matches, const Eigen::Matrix3d& R, double threshold, InlierScan* scan);

}  // namespace rcme
