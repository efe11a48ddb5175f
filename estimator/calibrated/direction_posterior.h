// Step 7 of rcme_calibrated where the parallax is hardly more than the noise: how likely each direction of
// the translation is, over the whole sphere, in place of a Gaussian about the answer.
//
// The Sampson residual is the part of a match's displacement across its epipolar line. Where the displacement
// is noise alone, every direction leaves about the same sum of squares, but sums over different parts of the
// noise differ by sqrt(n) nats, and the least of them looks like a well determined direction. So the part
// along the line is needed as well. With a the ray of camera 1 turned into camera 2, b that of camera 2, both
// unit vectors, and a direction t,
//
//   e = t - (t a) a,  sin = |e|,  e' = e / sin,  n = a x e'
//   across   n (b - a) + w e'                ~ N(0, s^2)
//   along    e' (b - a) - w n - m sin        ~ N(0, s^2 + v sin^2)
//
// w a small rotation, m and v mean and variance of the inverse depths in baselines, s the noise of the angle
// between two rays. Without parallax (m = v = 0) this is the same for all directions. A share of the matches,
// found by expectation-maximisation, may have a displacement of any size along the line (near points), and a
// small one is wrong, so that one wrong match does not decide. w and m are integrated out (uniform priors);
// m > 0, so that t and -t have the parts Phi(m / sd) and Phi(-m / sd) of their axis. A prior of the motion
// (MotionProblem::prior) adds its density to that of the matches: of the rotation and of gravity as a normal
// law of w, of the direction to the parts of t and -t.
#pragma once

#include <vector>

#include "estimator/calibrated/explain_matches.h"
#include "estimator/calibrated/motion_posterior.h"

namespace rcme {

struct DirectionPosterior {
  double mass_within = 0.0;  // the probability that the direction lies within the angle of the centre
  Mode best;  // the mode at the most likely direction, without the matches that are wrong there
};

// From the matches that the mode explains, at most 256 of them; `centre` is a unit vector.
DirectionPosterior PosteriorOfDirection(const MotionProblem& problem, const ExplainedMode& mode,
                                        const Eigen::Vector3d& centre, double angle_rad);

// The same posterior about the mode's own direction: its parts of the sphere, with an edge at the angle, and
// the rotation against the mode's given each. Weights sum to one.
std::vector<DirectionCell> ComputeDirectionCells(const MotionProblem& problem, const ExplainedMode& mode,
                                                 double angle_rad);

// The parallax in standard deviations of its noise (z, calibrated/mixture_parameters.h) that a fifth of the
// matches which the mode explains exceed.
double UsualDepthInNoise(const Explanation& explanation);

}  // namespace rcme
