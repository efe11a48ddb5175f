#pragma once

#include <cstdint>
#include <functional>

namespace rcme {

// Calls work(0), ..., work(n - 1), each once, on `num_threads` threads (0: one per core). Results do not
// depend on the number of threads if a call writes only data of its own index. The first exception ends the
// loop and is rethrown. A request to stop (stop_request.h) ends it too, with Stopped.
void ForEachIndex(std::int64_t n, int num_threads, const std::function<void(std::int64_t)>& work);

// Returns `num_threads`, or the number of cores if it is 0.
int NumThreads(int num_threads);

}  // namespace rcme
