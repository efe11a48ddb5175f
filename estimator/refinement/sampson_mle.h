// Maximum likelihood of the motion alone, without points: least squares of the Sampson distance. Where the
// noise is small against the parallax, g / |J| is the distance of a match from the epipolar variety up to
// second order and the optimum is that of RefineByReprojection, at a fraction of the time.
#pragma once

#include "estimator/motion_problem.h"
#include "estimator/refinement/reprojection_mle.h"

namespace rcme {

// Levenberg-Marquardt over the five coordinates of the motion on all matches (m >= 5) of the problem.
// pose_cov = (sum_k g_p' g_p / var g_k)^-1 at the optimum, 5x5, [rotation, direction], rad^2.
RefinedMotion RefineBySampson(const MotionProblem& problem, const RelativePose& start);

}  // namespace rcme
