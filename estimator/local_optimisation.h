// From a hypothesis that is better than all before it to a motion of more than a minimal sample: the step
// that LO-RANSAC and Cov-RANSAC add to the loop.
//
// "Good" samples give motions that are only as good as the noise of five or eight points: many right matches
// lie beyond the test, and a loop that counts inliers stops short of the motion it has already met.
#pragma once

#include <vector>

#include "estimator/motion_problem.h"
#include "estimator/refinement/motion_search.h"
#include "stats/random.h"

namespace rcme {

// A motion and the matches within the threshold of its squared Sampson distance over sigma^2, ascending.
struct Supported {
  RelativePose pose;
  std::vector<int> inliers;
};
Supported WithSupport(const MotionProblem& problem, const RelativePose& pose, double threshold);

// LO-RANSAC's step (Chum, Matas & Kittler 2003, section 3, "inner RANSAC" with the iterative method): samples
// of many inliers of the hypothesis, min(14, half of them); each sample's motion is fitted again and again to
// the matches within a threshold on |e| that falls from `first_threshold` times the test's to the test's.
struct InnerRansac {
  int num_samples = 10;
  int num_refits = 4;
  double first_threshold = 3.0;
};
// The best of the start and what is found, by inlier count. The fits are least squares of the Sampson
// distance over the motion's five degrees of freedom, from the start on.
Supported OptimiseByInnerRansac(const MotionProblem& problem, const Supported& start, double threshold,
                                const InnerRansac& options, RandomStream& rng);

// Cov-RANSAC's step (Raguram, Frahm & Pollefeys 2009): the covariance of the hypothesis's motion, propagated
// from the noise of its minimal sample, widens the test of each match: g^2 / |J|^2 <= threshold (sigma^2 +
// g_p Sigma_p g_p' / |J|^2), so that nearly all right matches pass. The motion fitted to these has a smaller
// covariance, and the test narrows with it, refit by refit, until the set stays the same or after
// `num_refits`. The best of the start and the last motion, by the inlier count of the test without widening.
Supported OptimiseByUncertainty(const MotionProblem& problem, const Supported& start,
                                const Matrix5d& start_cov, double threshold, int num_refits);

}  // namespace rcme
