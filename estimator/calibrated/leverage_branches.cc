#include "estimator/calibrated/leverage_branches.h"

#include <algorithm>

namespace rcme {
namespace {

constexpr int kBranchSteps = 12;
constexpr size_t kMostBranches = 3;

std::vector<int> InfluentialMatches(const Explanation& explanation) {
  std::vector<int> found;
  for (size_t i = 0; i < explanation.leverage.size(); ++i) {
    if (explanation.leverage[i] > kLargeLeverage) found.push_back(static_cast<int>(i));
  }
  std::stable_sort(found.begin(), found.end(), [&](int a, int b) {
    return explanation.leverage[static_cast<size_t>(a)] > explanation.leverage[static_cast<size_t>(b)];
  });
  if (found.size() > kMostBranches) found.resize(kMostBranches);
  return found;
}

}  // namespace

std::vector<Mode> LeverageBranches(const MatchBlocks& matches, const MixturePrior& prior, const Mode& mode,
                                   const Explanation& explanation) {
  const std::vector<int> influential = InfluentialMatches(explanation);
  std::vector<Mode> branches;
  const auto add_without = [&](const std::vector<int>& left_out) {
    Mode branch = mode;
    branch.origin = ModeOrigin::kLeverage;
    for (const int i : left_out) {
      branch.used[static_cast<size_t>(i / kBlockSize)] &=
          static_cast<std::uint8_t>(~(1u << (i % kBlockSize)));
    }
    if (FitMode(matches, prior, kBranchSteps, &branch)) branches.push_back(std::move(branch));
  };
  for (const int i : influential) add_without({i});
  if (influential.size() > 1) add_without(influential);
  return branches;
}

}  // namespace rcme
