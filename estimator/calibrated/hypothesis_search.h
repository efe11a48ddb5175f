// Step 1 of rcme_calibrated: essential matrices of five-point samples, ranked by a soft score.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimator/calibrated/calibrated_options.h"
#include "estimator/kernels/match_blocks.h"
#include "estimator/kernels/soft_score.h"
#include "estimator/motion_estimate.h"
#include "estimator/motion_prior.h"
#include "stats/random.h"

namespace rcme {

// Scale of the soft score in units of the assumed sigma. Little depends on it, so that a sigma assumed
// wrongly by four does little harm.
inline constexpr double kSoftScale = 2.5;

struct ScoredEssential {
  Eigen::Matrix3d E = Eigen::Matrix3d::Zero();  // in rays, Frobenius norm sqrt(2), up to its sign
  double score = 0.0;                           // of all matches
};

struct HypothesisSearch {
  std::vector<ScoredEssential> candidates;  // the best first
  LoopCounts counts;
};

// Draws between options.min_samples and options.max_samples samples, in rounds that double: as many as give a
// sample of right matches alone with probability 0.999. Every hypothesis is scored on the first kFirstMatches
// matches, whose order must not mean anything, and the best of a round on all. Returned are the best
// `options.num_candidates` distinct ones, half of them far from all others. Where a prior is given, half as
// many more: the best that are near it (IsNearPrior), as the camera's motion may explain fewer matches than
// another one. The samples are the same with it and without.
HypothesisSearch SearchHypotheses(const MatchBlocks& matches, const ScoreMatches& score_matches,
                                  const CalibratedOptions& options, RandomStream& rng,
                                  double soft_scale = kSoftScale, const MotionPrior* prior = nullptr);

// Whether one of the poses of E is where the prior has the motion, as far as the motion of a minimal sample
// shows that: it is off by some degrees.
bool IsNearPrior(const MotionPrior& prior, const Eigen::Matrix3d& E);

}  // namespace rcme
