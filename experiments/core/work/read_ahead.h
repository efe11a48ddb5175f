// Reads items on one thread while another thread visits the items already read.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace rcme {

// Calls read(&item) until it returns false, and visit(item) for each item, in order. `visit` runs on the
// calling thread, `read` on a thread of its own, a few batches ahead. An exception from `read` is rethrown
// here after the items of earlier calls are visited. An exception from `visit` ends the reading and is passed
// on.
template <typename Item, typename Read, typename Visit>
void ReadAhead(Read read, Visit visit) {
  using Batch = std::vector<Item>;
  constexpr size_t kBatchSize = 200, kMostBatches = 4;
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<Batch> waiting;
  bool is_at_end = false, is_given_up = false;
  std::exception_ptr error;

  const auto read_batch = [&](Batch* batch) {
    Item item;
    while (batch->size() < kBatchSize) {
      if (!read(&item)) return false;
      batch->push_back(std::move(item));
    }
    return true;
  };
  const auto read_all = [&] {
    for (bool may_have_more = true; may_have_more;) {
      Batch batch;
      std::exception_ptr thrown;
      try {
        may_have_more = read_batch(&batch);
      } catch (...) {
        thrown = std::current_exception();
        may_have_more = false;
      }
      std::unique_lock lock(mutex);
      changed.wait(lock, [&] { return waiting.size() < kMostBatches || is_given_up; });
      if (is_given_up) return;
      waiting.push_back(std::move(batch));
      error = thrown;
      is_at_end = !may_have_more;
      changed.notify_all();
    }
  };
  std::thread reader(read_all);
  // Joins the reader also if `visit` throws.
  struct Joining {
    std::mutex& mutex;
    std::condition_variable& changed;
    bool& is_given_up;
    std::thread& reader;
    ~Joining() {
      {
        const std::scoped_lock lock(mutex);
        is_given_up = true;
      }
      changed.notify_all();
      reader.join();
    }
  } joining{mutex, changed, is_given_up, reader};

  for (bool may_have_more = true; may_have_more;) {
    Batch batch;
    {
      std::unique_lock lock(mutex);
      changed.wait(lock, [&] { return !waiting.empty(); });
      batch = std::move(waiting.front());
      waiting.pop_front();
      may_have_more = !is_at_end || !waiting.empty();
    }
    changed.notify_all();
    for (Item& item : batch) visit(item);
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace rcme
