// What unknown errors of the calibration could do to the answer, and whether the matches show them.
//
// A camera may have errors of the logarithm of its focal length and of both coordinates of its principal
// point, and a radial distortion k1 that was not removed. theta are these errors over their usual standard
// deviations (intrinsics_check.cc): four if one camera took both images (IsOfOneCamera), eight for two. A
// priori theta is N(0, I).
//
// r are the residuals of the matches that the answer explains, in standard deviations, J = dr/dp and G =
// dr/dtheta their derivatives by the motion and by the errors, and W the weights of the mixture's likelihood.
// To first order the most likely motion given theta is p - M theta with
//
//   M = (J'WJ + U)^-1 J'WG,
//
// where U is the information of a motion that may be anything (standard deviations of about 70 deg). The
// likelihood that is maximised over the motion has in theta the score and the information
//
//   q = -(G - J M)' W r,   I_theta = G'WG - (J'WG)' M,
//
// so that given the matches theta is N(V q, V), V = (I_theta + I)^-1.
#pragma once

#include "estimator/calibrated/explanation.h"
#include "estimator/motion_problem.h"
#include "estimator/uncertainty/calibration_prior.h"

namespace rcme {

// The direction of the translation moves by D theta, where D are the last two rows of -M. Angles are clipped
// to [1e-5, 3] rad.
struct IntrinsicsCheck {
  double reach_rad = 1e-5;  // sqrt(tr D D'): the direction's standard deviation by errors of usual size
  double root_gain = 0.0;   // sqrt(q'Vq), at most 30: how clearly the matches show an error
  double shift_rad = 1e-5;  // |D V q|: how far the direction moves if the most likely errors are corrected
};

// Takes undistorted points as those of pinhole images, and turned pixels (whitened_problem.h) as those of the
// images: the probability of failure was fitted to this.
IntrinsicsCheck CheckIntrinsics(const MotionProblem& problem, const Mode& answer,
                                const Explanation& explanation);

struct IntrinsicsEvidence {
  static constexpr int kMostErrors = 8;
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostErrors, kMostErrors>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostErrors, 1>;
  Square information;                                                     // I_theta
  Vector score;                                                           // q
  Eigen::Matrix<double, 5, Eigen::Dynamic, 0, 5, kMostErrors> of_motion;  // -M, rad
  Vector stated_sd;  // standard deviations that are stated, over the usual ones; 0: not stated
};

// Exact to first order: errors are those of the lenses that the matches were undistorted by
// (MotionProblem::undistortion), and those of the principal point are in the pixels of the images
// (CalibrationPrior::of_pixels1, 2).
IntrinsicsEvidence FindIntrinsicsEvidence(const MotionProblem& problem, const Mode& answer,
                                          const Explanation& explanation, const CalibrationPrior& stated);

// What stated errors of the calibration add to the usual ones: the root of the excess of each variance, or 0.
// The check knows the usual errors: of the 9,000 draws that it was fitted to, 3,000 are of a population that
// has them (studies/any_condition.yaml).
CalibrationPrior ExceedUsualErrors(CalibrationPrior stated);

}  // namespace rcme
