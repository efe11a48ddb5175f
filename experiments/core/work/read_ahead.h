// Reads items on one thread while another thread visits the items already read.
#pragma once

#include <cstddef>
#include <exception>
#include <future>
#include <utility>
#include <vector>

namespace rcme {

// Calls read(&item) until it returns false, and visit(item) for each item, in order. `visit` runs on the
// calling thread, `read` on another, a batch ahead. An exception from `read` is rethrown here after the items
// of earlier calls are visited. An exception from `visit` ends the reading and is passed on.
template <typename Item, typename Read, typename Visit>
void ReadAhead(Read read, Visit visit) {
  struct Batch {
    std::vector<Item> items;
    bool may_have_more = true;
    std::exception_ptr error;
  };
  const auto read_batch = [&] {
    constexpr size_t kBatchSize = 200;
    Batch batch;
    try {
      Item item;
      while (batch.items.size() < kBatchSize && (batch.may_have_more = read(&item)))
        batch.items.push_back(std::move(item));
    } catch (...) {
      batch.error = std::current_exception();
    }
    return batch;
  };
  std::future<Batch> next = std::async(std::launch::async, read_batch);  // waits in its destructor
  for (bool may_have_more = true; may_have_more;) {
    Batch batch = next.get();
    may_have_more = batch.may_have_more && !batch.error;
    if (may_have_more) next = std::async(std::launch::async, read_batch);
    for (Item& item : batch.items) visit(item);
    if (batch.error) std::rethrow_exception(batch.error);
  }
}

}  // namespace rcme
