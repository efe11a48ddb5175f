#pragma once

#include "estimator/kernels/block_matches.h"
#include "estimator/kernels/block_search.h"
#include "estimator/point_consistency.h"

namespace rcme {

// The engine of `implementation: fast`: eight hypotheses and many matches at a time. See ransac_estimate.h.
template <RansacDecision Decision, typename SolverT>
struct FastEngine {
  using Solver = SolverT;
  using PointTest = typename Decision::PointTest;
  static constexpr BlockReading kReading = std::is_same_v<PointTest, KnownPoseTest> ? BlockReading::kKnownPose
                                           : std::is_same_v<PointTest, RankAwareTest>
                                               ? BlockReading::kRankAware
                                               : BlockReading::kAsPrinted;
  FastEngine(const MotionProblem& problem, const RansacOptions& options, RandomStream& rng)
      : blocks(problem),
        search(problem, blocks, options,
               {kReading, Decision::kTestsSample, options.selection == Selection::kPredictiveLikelihood},
               rng),
        matches(problem, blocks, options.refinement_error) {}
  MatchBlocks blocks;
  BlockSearch<Solver> search;
  BlockMatches matches;
};

}  // namespace rcme
