// The normal equations of a pure rotation, many matches at a time: what refinement/rotation_equations.h
// states, in whitened coordinates, where the residual e = x2 - h(x1) has covariance C = I + J J'.
#pragma once

#include "estimator/kernels/score.h"
#include "estimator/refinement/rotation_equations.h"

namespace rcme {

// Over the matches of the mask.
RotationEquations LinearizeRotation(const MatchBlocks& matches, const MatchMask& mask,
                                    const Eigen::Matrix3d& R, Loss loss);

// d2 <= threshold, and not behind camera 2.
void ScanRotation(const MatchBlocks& matches, const Eigen::Matrix3d& R, double threshold, InlierScan* scan);

}  // namespace rcme
