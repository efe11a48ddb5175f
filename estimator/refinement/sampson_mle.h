// Maximum likelihood of the motion alone, without points: least squares of the Sampson distance. Where the
// noise is small against the parallax, g / |J| is the distance of a match from the epipolar variety up to
// second order and the optimum is that of RefineByReprojection, at a fraction of the time.
#pragma once

#include <span>

#include "estimator/kernels/match_blocks.h"
#include "estimator/refinement/motion_search.h"

namespace rcme {

// `indices` names the matches to use, at least five. pose_cov = (sum_k g_p' g_p / var g_k)^-1 at the optimum,
// 5x5, [rotation, direction], rad^2. The last step is at most 0.0014 standard deviations long, and what it
// leaves is of second order; with Cauchy's loss, which serves to tell the wrong matches, 0.045.
RefinedMotion RefineBySampson(const MotionProblem& problem, std::span<const int> indices,
                              const RelativePose& start, Loss loss);
// The same with the matches already packed.
RefinedMotion RefineBySampson(const MatchBlocks& matches, const MatchMask& mask, const RelativePose& start,
                              Loss loss);

// All matches, squared loss: maximum likelihood where none is wrong.
RefinedMotion RefineAllBySampson(const MotionProblem& problem, const RelativePose& start);

}  // namespace rcme
