// The normal equations of a pure rotation, many matches at a time: x2 = h(x1), h the image of the rotated
// ray.
//
// Both points carry noise. In whitened coordinates the residual e = x2 - h(x1) has covariance C = I + J J',
// J = dh/dx1 (2x2), so that d2 = e' C^-1 e follows chi2_2 under the true rotation (to first order).
#pragma once

#include "estimator/kernels/score.h"
#include "estimator/refinement/motion_search.h"

namespace rcme {

// Over the matches of the mask. The rotation moves as in Retract, R <- Exp(w) R (rad).
struct RotationEquations {
  double energy = 0.0;                                 // sum d2
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  // - sum weight G' C^-1 e, G = dh/dw
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();   // sum weight G' C^-1 G
};

// The weight is 1, or Cauchy's 1 / (1 + d2 / c^2). A match that the rotation takes behind camera 2 has no
// part.
RotationEquations LinearizeRotation(const MatchBlocks& matches, const MatchMask& mask,
                                    const Eigen::Matrix3d& R, Loss loss);

// d2 <= threshold, and not behind camera 2.
void ScanRotation(const MatchBlocks& matches, const Eigen::Matrix3d& R, double threshold, InlierScan* scan);

}  // namespace rcme
