#include "experiments/for_each_index.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <mutex>

namespace rcme {
namespace {

constexpr std::int64_t kIndicesPerBatch = 16;

// Hands out the indices batch by batch under one lock, which also makes what a thread wrote visible to the
// one that reads it in the end.
class Counter {
 public:
  Counter(std::int64_t n, Progress* progress) : n_(n), progress_(progress) {}

  // The next batch [first, end), empty at the end; `num_done` is the size of the one before.
  std::pair<std::int64_t, std::int64_t> Next(std::int64_t num_done) {
    const std::lock_guard lock(mutex_);
    if (num_done > 0) progress_->Advance(num_done);
    const std::int64_t first = next_;
    next_ = std::min(n_, first + kIndicesPerBatch);
    return {first, next_};
  }

  // No more batches: a thread has failed, or all are done.
  void Stop() {
    const std::lock_guard lock(mutex_);
    next_ = n_;
  }

 private:
  std::mutex mutex_;
  std::int64_t n_, next_ = 0;
  Progress* progress_;
};

void RunBatches(Counter* counter, const std::function<void(std::int64_t)>& work) {
  try {
    for (std::int64_t num_done = 0;;) {
      const auto [first, end] = counter->Next(num_done);
      if (first == end) return;
      for (std::int64_t i = first; i < end; ++i) work(i);
      num_done = end - first;
    }
  } catch (...) {
    counter->Stop();
    throw;
  }
}

}  // namespace

void ForEachIndex(std::int64_t n, int num_threads, Progress* progress,
                  const std::function<void(std::int64_t)>& work) {
  const int threads = num_threads > 0 ? num_threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
  Counter counter(n, progress);
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(
        0, threads, [&](int) { RunBatches(&counter, work); }, tbb::simple_partitioner());
  });
  counter.Stop();
}

}  // namespace rcme
