// How many machines share the trials of a check that stops at its first verdict.
//
// Its trials have rounds. The first ends at the first look at which a verdict counts (TrialLimits::min), each
// later one at the first look with kRoundGrowth times the trials of those before, the last at the budget's
// end. A check that no verdict can end has one round of all its trials. Within a round nothing is looked at:
// its trials form blocks, as long as each other to within one trial, which any machine may run. After it the
// trials are looked at one after the other as one machine would have (CheckDecision), and where that ends the
// check no other round begins. So the verdict is that of one machine to the last bit, and what was run for
// nothing is less than a round: fewer trials than (kRoundGrowth * 1.25 - 1) times those that were needed, for
// looks are up to a quarter apart; none where the check runs to its budget.
#pragma once

#include <cstdint>
#include <vector>

#include "experiments/audit/claims/claim.h"

namespace rcme {

inline constexpr double kRoundGrowth = 1.5;
// Of a round, at most: so many machines have equal shares of it.
inline constexpr std::int64_t kBlocksOfRound = 64;

class TrialBlocks {
 public:
  TrialBlocks(const Check& check, Budget budget);

  // None of a check that is not possible.
  size_t NumBlocks() const { return begins_.size() - 1; }
  std::int64_t Begin(size_t block) const { return begins_[block]; }
  std::int64_t End(size_t block) const { return begins_[block + 1]; }
  // How many blocks there are to the end of the round that this block is in.
  size_t RoundEnd(size_t block) const;

 private:
  std::vector<std::int64_t> begins_ = {0};  // trials; the last is the end of all
  std::vector<size_t> round_ends_;          // blocks, ascending
};

}  // namespace rcme
