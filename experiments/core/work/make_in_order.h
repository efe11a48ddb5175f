// Values that several threads make, taken in their order.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <utility>

#include "experiments/core/work/for_each_index.h"

namespace rcme {

// Calls make(i) for i = 0, ..., n - 1 on `num_threads` threads (0: one per core), and take(value) for each in
// that order, one at a time, as soon as those before it are taken. Ends as ForEachIndex does.
template <typename Make, typename Take>
void MakeInOrder(std::int64_t n, int num_threads, Make make, Take take) {
  using Made = decltype(make(std::int64_t{}));
  std::mutex mutex;
  std::map<std::int64_t, Made> waiting;  // for one before them
  std::int64_t num_taken = 0;
  ForEachIndex(n, num_threads, [&](std::int64_t i) {
    Made made = make(i);
    const std::scoped_lock lock(mutex);
    waiting.emplace(i, std::move(made));
    for (; waiting.contains(num_taken); ++num_taken) take(waiting.extract(num_taken).mapped());
  });
}

}  // namespace rcme
