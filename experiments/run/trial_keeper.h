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

// Keeps the results of a run's trials: every record (run/run_study.h), or counts (statistics/count_study.h).
class TrialKeeper : public ItemKeeper {
 public:
  // Returns which of the first `num_trials` trials of a condition belong to the shard and have not been
  // kept, as ascending places in the shard.
  virtual std::vector<TrialRange> MissingTrials(std::uint32_t condition, std::uint32_t num_trials,
                                                const ShardTrials& shard) = 0;
  // Call this before the first new trial is kept. Returns a warning if kept trials have another origin, else
  // an empty text.
  virtual std::string NoteOrigin(const TrialOrigin& origin) = 0;
  // May be called from any thread.
  virtual void Keep(const TrialResult& result) = 0;
};

}  // namespace rcme
