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

// Scale of the soft score in units of the assumed sigma. The results depend little on it, so that an assumed
// sigma wrong by a factor of four does little harm.
inline constexpr double kSoftScale = 2.5;

struct ScoredEssential {
  Eigen::Matrix3d E = Eigen::Matrix3d::Zero();  // for rays, Frobenius norm sqrt(2), sign arbitrary
  double score = 0.0;                           // sum over all matches
};

// |<a, b>| / 2 of two E as in ScoredEssential: 1 if they are the same.
double ComputeSimilarity(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b);

struct HypothesisSearch {
  std::vector<ScoredEssential> candidates;  // best first
  int num_samples = 0;                      // of five matches
  LoopCounts counts;
};

// Draws between options.min_samples and options.max_samples minimal samples, in rounds that double their
// number. Stops as soon as at least one sample consists of inliers with probability 0.999. Every hypothesis
// is scored on the first 64 matches, whose order must be random; the best of a round are scored on all.
//
// Returns the best `options.num_candidates` distinct hypotheses; the second half of them also lie far from
// all others. With a prior, returns half as many more: the best that agree with it, because the camera's
// motion may explain fewer matches than another one. For this a sample's motion is taken to be off by 3 deg
// in each coordinate. The samples are the same with and without a prior.
HypothesisSearch SearchHypotheses(const MatchBlocks& matches, const ScoreMatches& score_matches,
                                  const CalibratedOptions& options, RandomStream& rng,
                                  double soft_scale = kSoftScale, const MotionPrior* prior = nullptr);

}  // namespace rcme
