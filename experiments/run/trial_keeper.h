#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/core/work/item_loop.h"
#include "experiments/core/work/shard.h"
#include "experiments/study/run_description.h"
#include "experiments/trial/trial.h"
#include "experiments/trial/trial_range.h"

namespace rcme {

// Where a run keeps what its trials give: every record (run/run_study.h), or counts
// (statistics/count_study.h).
class TrialKeeper : public ItemKeeper {
 public:
  // Those of the first `num_trials` trials of a condition that the shard has and nobody has kept yet, by
  // their place in the shard, ascending.
  virtual std::vector<TrialRange> MissingTrials(std::uint32_t condition, std::uint32_t num_trials,
                                                const ShardTrials& shard) = 0;
  // Before the first of them is kept. Returns a sentence of warning if those that are there are of another
  // origin, else nothing.
  virtual std::string NoteOrigin(const TrialOrigin& origin) = 0;
  // Any thread may call it.
  virtual void Keep(const TrialResult& result) = 0;
};

}  // namespace rcme
