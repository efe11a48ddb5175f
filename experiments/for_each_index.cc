#include "experiments/for_each_index.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>

namespace rcme {

void ForEachIndex(std::int64_t n, int num_threads, Progress* progress,
                  const std::function<void(std::int64_t)>& work) {
  const int threads = num_threads > 0 ? num_threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
  // Each thread takes one index at a time: that costs some ten nanoseconds, so larger portions would gain
  // nothing and leave threads idle at the end.
  std::atomic<std::int64_t> next = 0;
  const auto run = [&](int) {
    try {
      for (std::int64_t i = next++; i < n; i = next++) {
        work(i);
        progress->Advance(1);
      }
    } catch (...) {
      next = n;
      throw;
    }
  };
  tbb::task_arena arena(threads);
  arena.execute([&] { tbb::parallel_for(0, threads, run, tbb::simple_partitioner()); });
  next.load();  // makes what every thread wrote before its last look visible to this one
}

}  // namespace rcme
