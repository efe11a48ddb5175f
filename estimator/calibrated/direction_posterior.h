// Step 7 of rcme_calibrated if the parallax is hardly greater than the noise: the posterior of the
// translation direction over the whole sphere, in place of a Gaussian about the answer.
//
// The Sampson residual is the component of a match's displacement across its epipolar line. If displacements
// are pure noise, every direction leaves about the same sum of squares. But each direction sums other
// components of the noise, so that these sums differ by sqrt(n) nats, and the least of them looks like a well
// determined direction. The component along the line is therefore needed as well. Let a be the ray of camera
// 1 rotated into camera 2's frame, b the ray of camera 2 (both unit vectors), and t a direction:
//
//   e = t - (t a) a,  sin = |e|,  e' = e / sin,  n = a x e'
//   across   n (b - a) + w e'                ~ N(0, s^2)
//   along    e' (b - a) - w n - (p a) sin    ~ N(0, s^2 + v sin^2)
//
// The noise of rays whose pixels are not square depends on the direction: s^2 then differs across and along,
// and their correlation is taken into account.
//
// Here w is a small rotation, p a is the inverse depth, in baselines, of the plane p at ray a, v is the
// variance of the inverse depths about the plane, and s is the noise of the angle between two rays. Without
// parallax (p = v = 0) the density is the same for all directions. Without the plane's slopes the law would
// be sure of a wrong direction where depths depend on the place in the image: travel along the axis has a
// twin, as every motion over a plane, and the plane of that twin has no slope. Two kinds of matches have a
// component of any size along the line: near points, whose share is found by expectation-maximisation, and a
// small fixed share of outliers, so that one outlier does not decide.
//
// w and p are integrated out, w under a uniform prior. The prior of p is that of the parallax (p a) sin, the
// same for every direction. The plane lies in front: t has the weight of its axis times Phi(x), x the least
// inverse depth of the plane among the matches in its standard deviations, and -t times Phi(-x) of the
// greatest. A prior of the motion (MotionProblem::prior) multiplies the density of the matches: rotation and
// gravity as a normal law of w, the direction as a factor of the weights of t and -t.
#pragma once

#include <vector>

#include "estimator/calibrated/explain_matches.h"
#include "estimator/calibrated/motion_posterior.h"

namespace rcme {

struct DirectionPosterior {
  double mass_within = 0.0;   // probability that the direction lies within the angle of the centre
  double mass_of_both = 0.0;  // that it lies within the angle of the centre or of the most likely direction
  // 5x5 [rotation, direction], rad^2: the second moment about the mode's rotation and the centre, given that
  // the direction lies within 90 deg of the centre.
  Matrix5d covariance = Matrix5d::Zero();
  Mode best;  // the mode at the most likely direction, without the matches that are outliers there
};

// The posterior from the first 256 of the matches that the mode explains. `centre` is a unit vector.
DirectionPosterior PosteriorOfDirection(const MotionProblem& problem, const ExplainedMode& mode,
                                        const Eigen::Vector3d& centre, double angle_rad);

// The same posterior about the mode's own direction, as cells of the sphere with a border at `angle_rad`.
// Each cell has the rotation relative to the mode's, given the direction. The weights sum to one.
std::vector<DirectionCell> ComputeDirectionCells(const MotionProblem& problem, const ExplainedMode& mode,
                                                 double angle_rad);

// The 0.8 quantile of the parallax of the matches that the mode explains, in standard deviations of its noise
// (z of calibrated/mixture_parameters.h).
double UsualDepthInNoise(const Explanation& explanation);

}  // namespace rcme
