// The loop of all long work, whatever its items give and wherever that is kept: threads, progress, requests
// to stop (core/work/stop_request.h) and errors.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "experiments/core/work/progress.h"

namespace rcme {

// Where finished items are kept: in memory, in a part (core/work/runner.h), in a result file
// (run/trial_keeper.h).
class ItemKeeper {
 public:
  virtual ~ItemKeeper() = default;

  // Writes what is finished and not written yet.
  virtual void Flush() = 0;
  // What a stopped command says after that; `num_done`: what its progress shows.
  virtual std::string DescribeKept(std::int64_t num_done) const = 0;
};

// Computes and keeps one item; gives by how much progress advances. Called from several threads.
using FinishItem = std::function<std::int64_t(std::int64_t index)>;

// Items 0, ..., num_items - 1, on `num_threads` threads (0: one per core). A request to stop or the first
// error ends it: what is finished is flushed, then Stopped says what is kept, or the error is thrown on.
// `progress` may be null.
void FinishItems(std::int64_t num_items, int num_threads, Progress* progress, ItemKeeper* keeper,
                 const FinishItem& finish);

}  // namespace rcme
