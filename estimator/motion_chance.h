// Does a motion explain more matches than chance gives?
//
// Null hypothesis: the matches are random, each second point uniform in image 2 whatever the first. Then a
// match agrees with a given motion with the probability `chance` that a point falls into the band around the
// epipolar line, and of n matches k or more agree with probability P(Bin(n, chance) >= k) (the chances of the
// matches differ; by Hoeffding 1956 their mean bounds the tail).
//
// The motion, however, was chosen among many and fitted to what it explains. So the bound has to hold for all
// motions at once, as in Moisan & Stival 2004: move a motion along its five dimensions until five of the
// matches lie on the borders of their bands. That changes none of the other verdicts, so every set of
// agreeing matches belongs to one of the motions that five matches fix. There are C(n, 5) choices, 2 borders
// for each of the five, and at most 10 motions (Nister 2004): 320 C(n, 5) motions, each of them independent
// of the other n - 5 matches. The expected number of those that explain as many by chance is at most
//
//   NFA = 320 C(n, 5) P(Bin(n - 5, chance) >= k - 5),
//
// and so is the probability that there is one. However many hypotheses were drawn, and however they were
// refined, it holds; it is a bound, so that the true rate lies far below.
#pragma once

#include "estimator/geometry/pose.h"
#include "estimator/motion_problem.h"

namespace rcme {

// Upright rectangle in whitened coordinates of image 2.
struct Box {
  double low[2], high[2];
  double Area() const { return (high[0] - low[0]) * (high[1] - low[1]); }
};
// The least one around the second points in the image; the image where there are no two.
Box BoxOfSecondPoints(const MotionProblem& problem);

inline constexpr int kMostLookedAt = 128;  // matches

// Mean over the matches of the probability that the squared Sampson distance from x1 to a point uniform in
// image 2 is at most threshold sigma^2. "Image 2" is the least upright rectangle around the second points in
// it, as random matches lie where points are. At most 128 matches, evenly spaced in their order, are looked
// at. The twin that the fast implementation takes is kernels/agreement_chance.h.
double ChanceOfAgreement(const MotionProblem& problem, const RelativePose& pose, double threshold);

// The same for a rotation without a translation, and d2 <= threshold (refinement/rotation_equations.h): the
// area of the ellipse over that of the rectangle.
double ChanceOfAgreementWithRotation(const MotionProblem& problem, double threshold);

// The same for d2 = e' C^-1 e of any residual in image 2; `root_det` is sqrt(det C), C in units of sigma^2.
double ChanceOfAgreementInEllipse(const MotionProblem& problem, double threshold, double root_det);

// A family of models: `num_fixing` matches on the borders of their bands determine at most `most_per_choice`
// models.
struct ModelFamily {
  int num_fixing;
  double most_per_choice;
};
inline constexpr ModelFamily kMotions{5, 320.0};
// Three dimensions; to first order a border is a quadric, and three of these meet in at most 8 points.
inline constexpr ModelFamily kRotations{3, 8.0};
// Eight dimensions, in the same way.
inline constexpr ModelFamily kHomographies{8, 256.0};
// Of a motion whose rotation is known: great circles of the sphere; two meet in a direction and its opposite,
// which is the same epipolar geometry.
inline constexpr ModelFamily kDirections{2, 4.0};

// log NFA of `num_agreeing` among `num_matches`; infinite where no more agree than fix the model.
double LogFalseAlarms(const ModelFamily& family, int num_matches, int num_agreeing, double chance);

}  // namespace rcme
