#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <utility>

#include "experiments/core/work/stop_request.h"

namespace rcme {

// Calls work(0), ..., work(n - 1), each once, on `num_threads` threads (0: one per core). Results do not
// depend on the number of threads if a call writes only data of its own index. The first exception ends the
// loop and is rethrown. A request to stop (stop_request.h) ends it too, with Stopped.
void ForEachIndex(std::int64_t n, int num_threads, const std::function<void(std::int64_t)>& work);

// Returns `num_threads`, or the number of cores if it is 0.
int NumThreads(int num_threads);

// Makes values on several threads and takes them in the order of their indices: calls make(i) for i = 0, ...,
// n - 1 on `num_threads` threads (0: one per core). Calls take(value) for the values in the order of i, one
// at a time, as soon as all earlier values are taken. A thread that is far ahead waits. Exceptions and
// requests to stop end it as they end ForEachIndex.
template <typename Make, typename Take>
void MakeInOrder(std::int64_t n, int num_threads, Make make, Take take) {
  using Made = decltype(make(std::int64_t{}));
  const std::int64_t most_ahead = 16 * std::int64_t{NumThreads(num_threads)};
  std::mutex mutex;
  std::condition_variable changed;
  std::map<std::int64_t, Made> waiting;  // made, but an earlier value is not
  std::int64_t num_taken = 0;
  bool has_failed = false;

  const auto wait_for_turn = [&](std::int64_t i) {
    std::unique_lock lock(mutex);
    // A request to stop does not notify the condition variable.
    while (i - num_taken > most_ahead && !has_failed && !IsStopRequested())
      changed.wait_for(lock, std::chrono::milliseconds(50));
  };
  ForEachIndex(n, num_threads, [&](std::int64_t i) {
    wait_for_turn(i);
    try {
      Made made = make(i);
      const std::scoped_lock lock(mutex);
      waiting.emplace(i, std::move(made));
      for (; waiting.contains(num_taken); ++num_taken) take(waiting.extract(num_taken).mapped());
    } catch (...) {
      const std::scoped_lock lock(mutex);
      has_failed = true;
      changed.notify_all();
      throw;
    }
    changed.notify_all();
  });
}

}  // namespace rcme
