// The shape of the noise: how its variance depends on the direction in the image, estimated from the
// residuals of a mode. Motion blur, edges and compression make such noise. A shape that is not known costs
// precision, and where the parallax is small it makes a wrong motion more likely than the right one.
//
// Let the noise of a point have the covariance s^2 S (px^2) in both images, with
//
//   S = [1 + b, c; c, 1 - b],  |(b, c)| < 1.
//
// To first order the squared Sampson residual r^2 = g^2 / |J|^2 then has the mean
//
//   q = s^2 (j1' S j1 + j2' S j2) = s^2 (1 + b x + c y),  [j1; j2] = J' / |J|,
//   x = j1_u^2 - j1_v^2 + j2_u^2 - j2_v^2,  y = 2 (j1_u j1_v + j2_u j2_v).
//
// j1 and j2 are normal to the epipolar lines, so that b and c can be estimated if these have different
// directions. ln s^2, b and c maximise the likelihood of Student's law (mixture_parameters.h) with the scale
// sqrt(q), times a normal prior of b and c with standard deviation 1/2.
#pragma once

#include <optional>

#include "estimator/calibrated/explain_matches.h"
#include "estimator/calibrated/model_check.h"
#include "estimator/motion_problem.h"

namespace rcme {

struct NoiseShape {
  double b = 0.0, c = 0.0;
  // Of the log density of residuals and prior over that at b = c = 0 with its own s, nats: of the matches
  // used, and of as many as the mode explains.
  double gain = 0.0, gain_of_all = 0.0;
  // S scaled to a trace of 2, as above.
  Eigen::Matrix2d Covariance() const;
};

// From the first 512 of the matches that the mode explains; their order must be random. nullopt if there are
// fewer than 20, or if the residuals hardly depend on the direction of the lines.
std::optional<NoiseShape> FitNoiseShape(const MotionProblem& problem, const ExplainedMode& mode);

// Whether the residuals show anisotropic noise: a gain of at least 12 nats and standard deviations that
// differ by at least 30 % between the axes. Errors of the calibration also make residuals depend on the
// direction of the lines. They must explain less (IntrinsicsCheck::root_gain, not clipped), and neighbours
// must not share their residuals. The bounds were chosen on 400 conditions drawn from documented_ranges with
// seed 4711, and on the study anisotropic_noise.
bool IsNoiseAnisotropic(const NoiseShape& shape, const ModelCheck& check);

}  // namespace rcme
