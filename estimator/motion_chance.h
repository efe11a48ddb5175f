// A test whether a motion explains more matches than chance does.
//
// Null hypothesis: the matches are random, each second point uniform in image 2 and independent of the first.
// A match then agrees with a given motion with probability `chance`: the probability that a point falls into
// the band around the epipolar line. Of n matches k or more agree with probability P(Bin(n, chance) >= k).
// (The chances of the matches differ; by Hoeffding 1956 the binomial with their mean bounds the tail.)
//
// The motion, however, was chosen among many and fitted to the matches it explains, so the bound must hold
// for all motions at once (Moisan & Stival 2004). Move a motion along its five dimensions until five of the
// matches lie on the borders of their bands. This changes no other verdict, so every set of agreeing matches
// belongs to one of the motions that five matches fix. There are C(n, 5) choices of five matches, 2 borders
// for each match, and at most 10 motions (Nister 2004): 320 C(n, 5) motions, each of them independent of the
// other n - 5 matches. The expected number of motions that explain k matches or more by chance is at most
//
//   NFA = 320 C(n, 5) P(Bin(n - 5, chance) >= k - 5),
//
// the number of false alarms, which also bounds the probability that there is such a motion. The bound holds
// however many hypotheses were drawn and however they were refined; the true rate is far below it.
#pragma once

#include "estimator/geometry/pose.h"
#include "estimator/motion_problem.h"

namespace rcme {

// Upright rectangle in whitened coordinates of image 2.
struct Box {
  double low[2], high[2];
  double Area() const { return (high[0] - low[0]) * (high[1] - low[1]); }
};
// The smallest box around the second points that lie in the image; the whole image if they do not span a box.
Box BoxOfSecondPoints(const MotionProblem& problem);

inline constexpr int kMostLookedAt = 128;  // matches over which ChanceOfAgreement averages

// Mean over the matches of the probability that a point uniform in image 2 has a squared Sampson distance
// from x1 of at most threshold sigma^2. "Image 2" is BoxOfSecondPoints, as random matches lie where key
// points are. The mean is over at most 128 matches, evenly spaced in their order. The fast implementation is
// in kernels/agreement_chance.h.
double ChanceOfAgreement(const MotionProblem& problem, const RelativePose& pose, double threshold);

// The same for a rotation without translation and d2 <= threshold (refinement/rotation_equations.h): the area
// of the ellipse over that of the box.
double ChanceOfAgreementWithRotation(const MotionProblem& problem, double threshold);

// The same for d2 = e' C^-1 e of any residual in image 2; `root_det` is sqrt(det C), C in units of sigma^2.
double ChanceOfAgreementInEllipse(const MotionProblem& problem, double threshold, double root_det);

// A family of models: `num_fixing` matches on the borders of their bands fix at most `most_per_choice`
// models.
struct ModelFamily {
  int num_fixing;
  double most_per_choice;
};
inline constexpr ModelFamily kMotions{5, 320.0};
// Three dimensions. To first order a border is a quadric, and three quadrics meet in at most 8 points.
inline constexpr ModelFamily kRotations{3, 8.0};
// Eight dimensions; the same argument gives 2^8.
inline constexpr ModelFamily kHomographies{8, 256.0};
// Motions of known rotation. The borders are great circles of the sphere; two meet in a direction and its
// opposite, which have the same epipolar geometry.
inline constexpr ModelFamily kDirections{2, 4.0};

// log NFA of `num_agreeing` among `num_matches`; infinite if at most num_fixing matches agree.
double LogFalseAlarms(const ModelFamily& family, int num_matches, int num_agreeing, double chance);

}  // namespace rcme
