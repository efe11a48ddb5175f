#include "experiments/for_each_index.h"

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace rcme {

void ForEachIndex(std::int64_t n, int num_threads, Progress* progress,
                  const std::function<void(std::int64_t)>& work) {
  const int threads = num_threads > 0 ? num_threads : tbb::info::default_concurrency();
  // For estimators that use TBB themselves.
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
  // Each thread takes one index at a time: that costs some ten nanoseconds, so larger portions would gain
  // nothing and leave threads idle at the end.
  std::atomic<std::int64_t> next = 0;
  std::exception_ptr error;
  std::mutex error_mutex;
  const auto run = [&] {
    try {
      for (std::int64_t i = next++; i < n; i = next++) {
        work(i);
        progress->Advance(1);
      }
    } catch (...) {
      next = n;
      const std::lock_guard lock(error_mutex);
      if (!error) error = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    for (std::int64_t t = 1; t < std::min<std::int64_t>(threads, n); ++t) others.emplace_back(run);
    run();
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace rcme
