// Divides the trials of a check that stops at its first verdict among many machines.
//
// The trials are divided into rounds. The first round ends at the first look at which a verdict counts
// (TrialLimits::min). Each later one ends at the first look with kRoundGrowth times the trials before it, and
// the last at the end of the budget. A check that no verdict can end has a single round.
//
// Within a round there are no looks. Its trials form blocks whose lengths differ by at most one trial, and
// any machine may run a block. After the round the trials are examined one by one as on one machine
// (CheckDecision); if that ends the check, no further round begins. So the verdict is that of one machine to
// the last bit. The wasted trials are fewer than (kRoundGrowth * 1.25 - 1) times those needed, because looks
// are up to a quarter apart. None are wasted if the check runs to its budget.
#pragma once

#include <cstdint>
#include <vector>

#include "experiments/audit/claims/claim.h"

namespace rcme {

inline constexpr double kRoundGrowth = 1.5;

class TrialBlocks {
 public:
  TrialBlocks(const Check& check, Budget budget);

  // 0 for a check that is not possible.
  size_t NumBlocks() const { return begins_.size() - 1; }
  std::int64_t Begin(size_t block) const { return begins_[block]; }
  std::int64_t End(size_t block) const { return begins_[block + 1]; }
  // Number of blocks up to the end of the round of this block.
  size_t RoundEnd(size_t block) const;

 private:
  std::vector<std::int64_t> begins_ = {0};  // trials; the last entry is the total
  std::vector<size_t> round_ends_;          // blocks, ascending
};

}  // namespace rcme
