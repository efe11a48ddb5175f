// The loop of all long work. It handles threads, progress, requests to stop (core/work/stop_request.h) and
// errors, for any kind of items and any place that keeps their results.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "experiments/core/work/progress.h"

namespace rcme {

// Keeps finished items: in memory or in a part (core/work/runner.h), or in a result file
// (run/run_trials.h).
class ItemKeeper {
 public:
  virtual ~ItemKeeper() = default;

  // Writes the finished items that are not yet written.
  virtual void Flush() = 0;
  // The message of a stopped command, after Flush; `num_done`: the count that its progress shows.
  virtual std::string DescribeKept(std::int64_t num_done) const = 0;
};

// Computes and keeps one item; returns the amount by which progress advances. Called from several threads.
using FinishItem = std::function<std::int64_t(std::int64_t index)>;

// Finishes the items 0, ..., num_items - 1 on `num_threads` threads (0: one per core). A request to stop or
// the first error ends the loop: it flushes the finished items, then throws Stopped, whose message is
// DescribeKept, or rethrows the error. `progress` may be null.
void FinishItems(std::int64_t num_items, int num_threads, Progress* progress, ItemKeeper* keeper,
                 const FinishItem& finish);

}  // namespace rcme
