#include "estimator/calibrated/split_mode.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "estimator/calibrated/candidates.h"
#include "estimator/calibrated/explanation.h"
#include "estimator/calibrated/hypothesis_search.h"
#include "estimator/calibrated/neighbour_matches.h"
#include "estimator/noise_scale.h"

namespace rcme {
namespace {

constexpr int kSplitSteps = 15, kSplitShareSteps = 6;
// Greatest numbers of samples and of candidates of a search.
struct SearchEffort {
  int max_samples, num_candidates;
};
constexpr SearchEffort kForSplit{512, 8}, kForSecond{128, 2};
constexpr double kTightScale = 1.5;  // of the soft score, in units of the assumed sigma
// relative to one motion's noise level; above, a mode may be a compromise
constexpr double kWideScale = 1.15;
constexpr size_t kLeastMatches = 12;  // of the second motion
// Of the first kFirst matches, those that are off by kWrong standard deviations of the first mode's noise
// move together if more than kLeastCoherence of them do. Among all matches that an answer did not explain, 0
// to 5 % do on average, by outlier model, and about a fifth or more beside a moving object.
constexpr int kFirst = 128;
constexpr double kWrong = 6.0, kLeastCoherence = 0.1;
// Nats: pays for the search for the second motion and its five parameters, with a margin.
constexpr double kLeastSplitGain = 40.0;

// The matches that the mode does not explain.
std::vector<size_t> Unexplained(const Explanation& explanation) {
  std::vector<size_t> found;
  for (size_t i = 0; i < explanation.probability.size(); ++i) {
    if (!(explanation.probability[i] > 0.5)) found.push_back(i);
  }
  return found;
}

void Leave(const std::vector<size_t>& only, MatchMask* mask) {
  std::ranges::fill(*mask, std::uint8_t{0});
  for (const size_t i : only) (*mask)[i / kBlockSize] |= static_cast<std::uint8_t>(1u << (i % kBlockSize));
}

// Whether the matches that the mode does not explain move as their neighbours do, judged by the first of
// them.
bool IsRestCoherent(const MotionProblem& problem, const MatchBlocks& matches, const Mode& mode) {
  MatchTermLists terms;
  EvaluateTerms(matches, mode.pose, &terms, kFirst);
  std::vector<size_t> wrong;
  const auto n = static_cast<size_t>(std::min(matches.num_matches(), kFirst));
  for (size_t i = 0; i < n; ++i)
    if (std::abs(terms.residual[i]) > kWrong * mode.mixture.scale) wrong.push_back(i);
  return wrong.size() >= kLeastMatches && ComputeCoherence(problem, wrong) > kLeastCoherence;
}

// Whether the mode explains a quarter of some of the matches, and a dozen.
bool ExplainsEnough(const MatchBlocks& matches, const Mode& mode, const std::vector<size_t>& some) {
  const Explanation explanation = Explain(matches, mode);
  const auto count = static_cast<size_t>(
      std::ranges::count_if(some, [&](size_t i) { return explanation.probability[i] > 0.5; }));
  return count >= kLeastMatches && 4 * count >= some.size();
}

// The best motion of some of the matches at the assumed scale. Samples are ranked and candidates refined at
// this scale, too: at a wider one, a compromise between two motions would win.
std::optional<Mode> SearchMotion(const MotionProblem& problem, const MatchBlocks& matches,
                                 const MixturePrior& fixed, const std::vector<size_t>& some,
                                 const SearchEffort& effort, RandomStream& rng) {
  const MatchBlocks blocks(SelectPart(problem, some));
  CalibratedOptions options;
  options.max_samples = effort.max_samples;
  options.num_candidates = effort.num_candidates;
  const HypothesisSearch search = SearchHypotheses(blocks, ScoreMatches(blocks), options, rng, kTightScale);
  std::optional<Mode> best;
  for (const ScoredEssential& candidate : search.candidates) {
    Mode mode;
    mode.pose = PoseInFront(blocks, candidate.E);
    mode.mixture = FirstGuess(fixed, NoiseLaw().scale_of_gaussian, 0.5);
    mode.used = matches.All();
    Leave(some, &mode.used);
    const bool is_fitted = FitMode(matches, fixed, kSplitSteps, &mode);
    if (is_fitted && (!best || mode.log_likelihood > best->log_likelihood)) best = mode;
  }
  return best;
}

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
  for (int step = 0; step <= kSplitShareSteps; ++step) {
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
  MixturePrior fixed = prior;
  fixed.estimates_scale = false;
  fixed.motion = nullptr;  // one of the two is not the camera's
  std::vector<size_t> all(problem.matches.size());
  std::iota(all.begin(), all.end(), size_t{0});
  std::optional<Mode> first = SearchMotion(problem, matches, fixed, all, kForSplit, rng);
  if (!first) return std::nullopt;
  const Explanation by_first = Explain(matches, *first);
  const std::vector<size_t> rest = Unexplained(by_first);
  if (rest.size() < kLeastMatches) return std::nullopt;
  std::optional<Mode> second = SearchMotion(problem, matches, fixed, rest, kForSplit, rng);
  if (!second) return std::nullopt;
  const TwoMotions mix = Mix(by_first, Explain(matches, *second), prior.uniform_density);
  const double of_prior = prior.motion != nullptr ? EvaluatePrior(*prior.motion, mode.pose).cost : 0.0;
  if (mix.log_likelihood < mode.log_likelihood + of_prior + kLeastSplitGain) return std::nullopt;
  Leave(mix.not_of_second, &first->used);
  Leave(mix.not_of_first, &second->used);
  for (Mode* found : {&*first, &*second}) {
    if (!FitMode(matches, prior, kSplitSteps, found)) return std::nullopt;
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

void AddSecondMotion(const MotionProblem& problem, const MatchBlocks& matches, const MixturePrior& prior,
                     std::vector<Mode>* modes, RandomStream& rng) {
  if (modes->empty() || !IsRestCoherent(problem, matches, modes->front())) return;
  const std::vector<size_t> not_of_first = Unexplained(Explain(matches, modes->front()));
  std::vector<size_t> rest = not_of_first;
  for (size_t k = 1; k < modes->size(); ++k) {
    const Explanation explanation = Explain(matches, (*modes)[k]);
    std::erase_if(rest, [&](size_t i) { return explanation.probability[i] > 0.5; });
  }
  if (rest.size() < kLeastMatches) return;
  MixturePrior fixed = prior;
  fixed.estimates_scale = false;
  fixed.motion = nullptr;
  std::optional<Mode> found = SearchMotion(problem, matches, fixed, rest, kForSecond, rng);
  if (!found || !ExplainsEnough(matches, *found, rest)) return;
  Leave(not_of_first, &found->used);
  const bool is_new =
      FitMode(matches, prior, kSplitSteps, &*found) &&
      std::ranges::none_of(*modes, [&](const Mode& mode) { return IsSameMode(mode, *found); });
  if (is_new) modes->push_back(std::move(*found));
}

}  // namespace rcme
