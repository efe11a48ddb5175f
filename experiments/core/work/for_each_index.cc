#include "experiments/core/work/for_each_index.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "experiments/core/work/stop_request.h"

namespace rcme {

int NumThreads(int num_threads) {
  return num_threads > 0 ? num_threads : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

void ForEachIndex(std::int64_t n, int num_threads, const std::function<void(std::int64_t)>& work) {
  // Each thread takes one index at a time: that costs some ten nanoseconds, so larger portions would gain
  // nothing and leave threads idle at the end.
  std::atomic<std::int64_t> next = 0;
  std::atomic<bool> is_stopped = false;
  std::exception_ptr error;
  std::mutex error_mutex;
  const auto run = [&] {
    try {
      for (std::int64_t i = next++; i < n; i = next++) {
        if (IsStopRequested()) {
          is_stopped = true;
          return;
        }
        work(i);
      }
    } catch (...) {
      next = n;
      const std::lock_guard lock(error_mutex);
      if (!error) error = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    for (std::int64_t t = 1; t < std::min<std::int64_t>(NumThreads(num_threads), n); ++t)
      others.emplace_back(run);
    run();
  }
  if (error) std::rethrow_exception(error);
  if (is_stopped) throw Stopped("stopped; nothing was written");
}

}  // namespace rcme
