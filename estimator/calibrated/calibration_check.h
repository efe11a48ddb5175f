// What errors of the calibration could do to the answer, and whether the matches show them.
//
// Errors of usual size are added to the intrinsics of a camera: theta ~ N(0, I) are those of the logarithm of
// the focal length, both coordinates of the principal point, and k1 of the radial distortion, each over its
// standard deviation. A camera that took both images has four, two cameras have eight. Let r be the residuals
// of the matches that the answer explains, in standard deviations, J = dr/dp and G = dr/dtheta their
// derivatives by the motion and by the errors, and W the weights of the mixture's likelihood. To first order
// the motion p maximises the likelihood, beside theta, at p - M theta, M = (J'WJ + U)^-1 J'WG. With the
// motion maximised out, theta has the score q = -(G - J M)' W r and the information I_theta = G'WG - (J'WG)'
// M. Its posterior given the matches is N(V q, V), V = (I_theta + I)^-1.
//
// U is the information of a motion that may be anything: its standard deviations are about 70 deg.
#pragma once

#include "estimator/calibrated/explanation.h"
#include "estimator/motion_problem.h"

namespace rcme {

// The direction of the translation moves by D theta, where D are the last two rows of -M. Lengths are cut to
// [1e-5, 3].
struct CalibrationCheck {
  double reach_rad = 1e-5;  // sqrt(tr D D'): the direction's standard deviation by errors of usual size
  double root_gain = 0.0;   // sqrt(q'Vq), at most 30: how clearly the matches show an error
  double shift_rad = 1e-5;  // |D V q|: how far the direction moves if the most likely errors are corrected
};

CalibrationCheck CheckCalibration(const MotionProblem& problem, const Mode& answer,
                                  const Explanation& explanation);

}  // namespace rcme
