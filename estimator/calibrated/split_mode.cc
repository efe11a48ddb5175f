#include "estimator/calibrated/split_mode.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "estimator/calibrated/part_search.h"

namespace rcme {
namespace {

constexpr SearchEffort kSplitEffort{.max_samples = 512, .num_candidates = 8};
constexpr int kShareSteps = 6;
// relative to one motion's noise level; above, a mode may be a compromise
constexpr double kWideScale = 1.15;
// Nats: pays for the search for the second motion and its five parameters, with a margin.
constexpr double kLeastSplitGain = 40.0;

struct TwoMotions {
  double log_likelihood = 0.0;
  std::vector<size_t> not_of_first, not_of_second;  // matches that the other explains better
};

// The mixture of both motions, each with its own share by expectation-maximisation, and of outliers of
// density q.
TwoMotions Mix(const Explanation& a, const Explanation& b, double q) {
  const size_t n = a.inlier_density.size();
  double share_a = 0.4, share_b = 0.3;
  TwoMotions mix;
  for (int step = 0; step <= kShareSteps; ++step) {
    double sum_a = 0.5, sum_b = 0.5;
    mix = {};
    for (size_t i = 0; i < n; ++i) {
      const double of_a = share_a * a.inlier_density[i], of_b = share_b * b.inlier_density[i];
      const double all = of_a + of_b + (1.0 - share_a - share_b) * WrongDensity(a, i, q);
      sum_a += of_a / all;
      sum_b += of_b / all;
      mix.log_likelihood += std::log(all);
      if (of_b > of_a) mix.not_of_first.push_back(i);
      if (of_a > of_b) mix.not_of_second.push_back(i);
    }
    share_a = sum_a / (static_cast<double>(n) + 1.5);
    share_b = sum_b / (static_cast<double>(n) + 1.5);
  }
  return mix;
}

}  // namespace

std::optional<std::pair<Mode, Mode>> SplitMode(const MotionProblem& problem, const MatchBlocks& matches,
                                               const MixturePrior& prior, const Mode& mode,
                                               RandomStream& rng) {
  const MixturePrior part_prior = MakePartPrior(prior);  // one of the two is not the camera's
  std::vector<size_t> all(problem.matches.size());
  std::iota(all.begin(), all.end(), size_t{0});
  std::optional<Mode> first = SearchPart(problem, matches, part_prior, all, kSplitEffort, rng);
  if (!first) return std::nullopt;
  const Explanation by_first = Explain(matches, *first);
  const std::vector<size_t> rest = FindUnexplained(by_first);
  if (rest.size() < kLeastOfSecondMotion) return std::nullopt;
  std::optional<Mode> second = SearchPart(problem, matches, part_prior, rest, kSplitEffort, rng);
  if (!second) return std::nullopt;
  const TwoMotions mix = Mix(by_first, Explain(matches, *second), prior.uniform_density);
  const double of_prior = prior.motion != nullptr ? EvaluatePrior(*prior.motion, mode.pose).cost : 0.0;
  if (mix.log_likelihood < mode.log_likelihood + of_prior + kLeastSplitGain) return std::nullopt;
  UseOnly(mix.not_of_second, &first->used);
  UseOnly(mix.not_of_first, &second->used);
  for (Mode* found : {&*first, &*second}) {
    if (!FitMode(matches, prior, kPartSteps, found)) return std::nullopt;
    FitShares(matches, prior, found);
  }
  return std::pair{*first, *second};
}

void SplitCompromise(const MotionProblem& problem, const MatchBlocks& matches, const MixturePrior& prior,
                     std::vector<Mode>* modes, RandomStream& rng) {
  if (modes->empty() || modes->front().mixture.scale < kWideScale * NoiseLaw().scale_of_gaussian) return;
  const auto split = SplitMode(problem, matches, prior, modes->front(), rng);
  if (!split) return;
  const double scale = std::max(split->first.mixture.scale, split->second.mixture.scale);
  std::erase_if(*modes, [&](const Mode& mode) { return mode.mixture.scale > kWideScale * scale; });
  modes->push_back(split->first);
  modes->push_back(split->second);
}

}  // namespace rcme
