#include "estimator/calibrated/part_search.h"

#include <algorithm>

#include "estimator/calibrated/candidates.h"
#include "estimator/calibrated/hypothesis_search.h"
#include "estimator/noise_scale.h"

namespace rcme {

MixturePrior MakePartPrior(const MixturePrior& prior) {
  MixturePrior of_part = prior;
  of_part.estimates_scale = false;
  of_part.motion = nullptr;
  return of_part;
}

std::vector<size_t> FindUnexplained(const Explanation& explanation) {
  std::vector<size_t> found;
  for (size_t i = 0; i < explanation.probability.size(); ++i) {
    if (!(explanation.probability[i] > 0.5)) found.push_back(i);
  }
  return found;
}

void UseOnly(const std::vector<size_t>& some, MatchMask* mask) {
  std::ranges::fill(*mask, std::uint8_t{0});
  for (const size_t i : some) (*mask)[i / kBlockSize] |= static_cast<std::uint8_t>(1u << (i % kBlockSize));
}

std::optional<Mode> SearchPart(const MotionProblem& problem, const MatchBlocks& matches,
                               const MixturePrior& part_prior, const std::vector<size_t>& some,
                               const SearchEffort& effort, RandomStream& rng) {
  constexpr double kTightScale = 1.5;  // of the soft score, in units of the assumed sigma
  const MatchBlocks blocks(SelectPart(problem, some));
  CalibratedOptions options;
  options.max_samples = effort.max_samples;
  options.num_candidates = effort.num_candidates;
  const HypothesisSearch search = SearchHypotheses(blocks, ScoreMatches(blocks), options, rng, kTightScale);
  std::optional<Mode> best;
  for (const ScoredEssential& candidate : search.candidates) {
    Mode mode;
    mode.pose = PoseInFront(blocks, candidate.E);
    mode.mixture = FirstGuess(part_prior, NoiseLaw().scale_of_gaussian, 0.5);
    mode.used = matches.All();
    UseOnly(some, &mode.used);
    const bool is_fitted = FitMode(matches, part_prior, kPartSteps, &mode);
    if (is_fitted && (!best || mode.log_likelihood > best->log_likelihood)) best = mode;
  }
  return best;
}

}  // namespace rcme
