// Step 1 of rcme_calibrated if gravity is measured in both cameras: hypotheses of three matches.
//
// If a share w of the matches are inliers, a sample of three consists of inliers with probability w^3, one of
// five with w^5. So there are good hypotheses among a quarter as many samples as of five matches, even where
// five matches are hardly ever all inliers (w = 0.2: one sample in 125 in place of 3125).
//
// The error of the measured gravity moves the epipolar lines of a good sample by about focal length times
// standard deviation, far more than the noise of the matches. Hence samples are ranked at a scale that admits
// it, and the best are refined with the prior of the motion while this scale shrinks. A bad prior costs
// time: refined hypotheses are candidates among others, and the check of the prior comes later.
#pragma once

#include <vector>

#include "estimator/calibrated/hypothesis_search.h"
#include "estimator/calibrated/mixture_fit.h"

namespace rcme {

// Adds the best hypotheses of `num_samples` samples of three matches to the candidates of `search`, at most
// `count`; the best of them is the first candidate if its score is greater. Does nothing without a
// measurement of gravity in `prior`, or if its error is so large that it says nothing.
void AddUprightCandidates(const MatchBlocks& matches, const ScoreMatches& score_matches,
                          const MixturePrior& prior, int num_samples, size_t count, RandomStream& rng,
                          HypothesisSearch* search);

}  // namespace rcme
