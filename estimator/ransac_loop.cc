#include "estimator/ransac_loop.h"

namespace rcme {

LoopResult SelectWinner(const CandidateSet& candidates, const RansacOptions& options, DecidingScore decides,
                        const LoopCounts& counts) {
  LoopResult result;
  result.counts = counts;
  result.counts.num_candidates = candidates.CountMembers();
  result.counts.num_too_small_inlier_sets = counts.num_hypotheses - counts.num_degenerate_samples -
                                            counts.num_inconsistent_samples - counts.num_poor_inlier_sets -
                                            result.counts.num_candidates;
  result.runners_up = candidates.SelectBest(options.num_refined, decides);
  if (result.runners_up.empty()) return result;
  result.winner = result.runners_up.front();
  result.runners_up.erase(result.runners_up.begin());
  return result;
}

}  // namespace rcme
