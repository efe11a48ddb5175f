#include "experiments/audit/claims/trial_blocks.h"

#include <algorithm>

#include "experiments/audit/claims/decide_check.h"

namespace rcme {
namespace {

// Most blocks of a round: up to this many machines get equal shares.
constexpr std::int64_t kBlocksOfRound = 64;

// The first look with at least this many trials.
std::int64_t LookWith(const Check& check, Budget budget, double num_trials) {
  std::int64_t look = 0;
  do look = NextLook(check, budget, look);
  while (static_cast<double>(look) < num_trials && look < check.limits.Max(budget));
  return look;
}

}  // namespace

TrialBlocks::TrialBlocks(const Check& check, Budget budget) {
  if (!check.not_possible.empty()) return;
  const std::int64_t max_trials = check.limits.Max(budget);
  double wanted =
      CanEndEarly(check) ? static_cast<double>(check.limits.min) : static_cast<double>(max_trials);
  while (begins_.back() < max_trials) {
    const std::int64_t begin = begins_.back(), num_trials = LookWith(check, budget, wanted) - begin;
    const std::int64_t num_blocks = std::min(num_trials, kBlocksOfRound);
    for (std::int64_t block = 1; block <= num_blocks; ++block)
      begins_.push_back(begin + num_trials * block / num_blocks);
    round_ends_.push_back(begins_.size() - 1);
    wanted = kRoundGrowth * static_cast<double>(begins_.back());
  }
}

size_t TrialBlocks::RoundEnd(size_t block) const { return *std::ranges::upper_bound(round_ends_, block); }

}  // namespace rcme
