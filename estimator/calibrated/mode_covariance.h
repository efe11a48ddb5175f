// Step 8 of rcme_calibrated: the covariance of a mode.
#pragma once

#include "estimator/calibrated/calibrated_options.h"
#include "estimator/calibrated/explanation.h"
#include "estimator/motion_problem.h"

namespace rcme {

// H^-1 S H^-1 with H the Hessian of the likelihood at the optimum and S = sum (p psi / ((1 - h) s))^2 J'J,
// psi = v u: the residuals give their own variances, and a residual with leverage h is smaller than its error
// by 1 - h (HC3, MacKinnon and White 1985). 5x5 [rotation, direction], rad^2. The inverse information H^-1
// where the sandwich is not finite.
Matrix5d SandwichCovariance(const MatchBlocks& matches, const Mode& mode, const Explanation& explanation);

// J_K Sigma_K J_K', what uncertain intrinsics add: J_K = -H^-1 dgradient / dK, by differences of one standard
// deviation each of focal length and principal point of either camera. A focal error common to both cameras,
// as that of one camera that took both images, is what `focal_sd` means where the two have the same
// intrinsics.
Matrix5d IntrinsicsCovariance(const MotionProblem& problem, const CalibratedOptions& options,
                              const Mode& mode);

}  // namespace rcme
