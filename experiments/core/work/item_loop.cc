#include "experiments/core/work/item_loop.h"

#include "experiments/core/work/for_each_index.h"
#include "experiments/core/work/stop_request.h"

namespace rcme {

void FinishItems(std::int64_t num_items, int num_threads, Progress* progress, ItemKeeper* keeper,
                 const FinishItem& finish) {
  try {
    ForEachIndex(num_items, num_threads, [&](std::int64_t index) {
      const std::int64_t amount = finish(index);
      if (progress) progress->Advance(amount);
    });
  } catch (const Stopped&) {
    keeper->Flush();
    throw Stopped(keeper->DescribeKept(progress ? progress->num_done() : 0));
  } catch (...) {
    keeper->Flush();  // the items before the error are good
    throw;
  }
}

}  // namespace rcme
