// Local optimisation: the step that LO-RANSAC and Cov-RANSAC add to the loop. It fits the motion of a new
// best hypothesis to more matches than a minimal sample.
//
// The motion of a minimal sample without outliers is only as accurate as the noise of five or eight points
// allows. Many true matches then fail the inlier test, so that inlier counts underrate a motion that is
// nearly right.
#pragma once

#include <vector>

#include "estimator/motion_problem.h"
#include "estimator/refinement/motion_search.h"
#include "stats/random.h"

namespace rcme {

// A motion and its inliers: the matches with squared Sampson distance over sigma^2 at most the threshold,
// ascending.
struct Supported {
  RelativePose pose;
  std::vector<int> inliers;
};
Supported WithSupport(const MotionProblem& problem, const RelativePose& pose, double threshold);

// LO-RANSAC's step (Chum, Matas & Kittler 2003, section 3, "inner RANSAC" with the iterative method). It
// draws samples of min(14, half of the inliers) from the inliers of the hypothesis. The motion of each sample
// is refitted several times to the matches within a threshold. This threshold on |e| falls from
// `first_threshold` times the inlier test's to the inlier test's own.
struct InnerRansac {
  int num_samples = 10;
  int num_refits = 4;
  double first_threshold = 3.0;
};
// Returns the start or the best motion found, whichever has more inliers. Each fit minimises the squared
// Sampson distance over the five degrees of freedom of the motion, beginning at the start's motion.
Supported OptimiseByInnerRansac(const MotionProblem& problem, const Supported& start, double threshold,
                                const InnerRansac& options, RandomStream& rng);

// Cov-RANSAC's step (Raguram, Frahm & Pollefeys 2009). The covariance of the motion, at first propagated from
// the noise of the minimal sample, widens the test of each match: g^2 / |J|^2 <= threshold (sigma^2 + g_p
// Sigma_p g_p' / |J|^2). Nearly all true matches pass. The motion fitted to them has a smaller covariance, so
// the test narrows with each refit. This ends when the set stays the same or after `num_refits`. Returns the
// start or the last motion, whichever has more inliers in the test without widening.
Supported OptimiseByUncertainty(const MotionProblem& problem, const Supported& start,
                                const Matrix5d& start_cov, double threshold, int num_refits);

}  // namespace rcme
