#include "estimator/calibrated/second_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/calibrated/candidates.h"
#include "estimator/calibrated/neighbour_matches.h"
#include "estimator/calibrated/part_search.h"

namespace rcme {
namespace {

constexpr SearchEffort kSecondMotionEffort{.max_samples = 128, .num_candidates = 2};
// Of the first kFirst matches, those that are off by kWrong standard deviations of the first mode's noise
// move together if more than kLeastCoherence of them do. Among all matches that an answer did not explain, 0
// to 5 % do on average, by outlier model, and about a fifth or more beside a moving object.
constexpr int kFirst = 128;
constexpr double kWrong = 6.0, kLeastCoherence = 0.1;

// Whether the matches that the mode does not explain move as their neighbours do, judged by the first of
// them.
bool IsRestCoherent(const MotionProblem& problem, const MatchBlocks& matches, const Mode& mode) {
  MatchTermLists terms;
  EvaluateTerms(matches, mode.pose, &terms, kFirst);
  std::vector<size_t> wrong;
  const auto n = static_cast<size_t>(std::min(matches.num_matches(), kFirst));
  for (size_t i = 0; i < n; ++i)
    if (std::abs(terms.residual[i]) > kWrong * mode.mixture.scale) wrong.push_back(i);
  return wrong.size() >= kLeastOfSecondMotion && ComputeCoherence(problem, wrong) > kLeastCoherence;
}

// Whether the mode explains a quarter of some of the matches, and a dozen.
bool ExplainsEnough(const MatchBlocks& matches, const Mode& mode, const std::vector<size_t>& some) {
  const Explanation explanation = Explain(matches, mode);
  const auto count = static_cast<size_t>(
      std::ranges::count_if(some, [&](size_t i) { return explanation.probability[i] > 0.5; }));
  return count >= kLeastOfSecondMotion && 4 * count >= some.size();
}

}  // namespace

void AddSecondMotion(const MotionProblem& problem, const MatchBlocks& matches, const MixturePrior& prior,
                     std::vector<Mode>* modes, RandomStream& rng) {
  if (modes->empty() || !IsRestCoherent(problem, matches, modes->front())) return;
  const std::vector<size_t> not_of_first = FindUnexplained(Explain(matches, modes->front()));
  std::vector<size_t> rest = not_of_first;
  for (size_t k = 1; k < modes->size(); ++k) {
    const Explanation explanation = Explain(matches, (*modes)[k]);
    std::erase_if(rest, [&](size_t i) { return explanation.probability[i] > 0.5; });
  }
  if (rest.size() < kLeastOfSecondMotion) return;
  std::optional<Mode> found =
      SearchPart(problem, matches, MakePartPrior(prior), rest, kSecondMotionEffort, rng);
  if (!found || !ExplainsEnough(matches, *found, rest)) return;
  UseOnly(not_of_first, &found->used);
  const bool is_new =
      FitMode(matches, prior, kPartSteps, &*found) &&
      std::ranges::none_of(*modes, [&](const Mode& mode) { return IsSameMode(mode, *found); });
  if (is_new) modes->push_back(std::move(*found));
}

}  // namespace rcme
