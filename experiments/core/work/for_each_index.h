#pragma once

#include <cstdint>
#include <functional>

namespace rcme {

// Calls work(0), ..., work(n - 1), each once, on `num_threads` threads (0: one per core). Results do not
// depend on the number of threads if a call writes only what belongs to its index. The first exception ends
// it and is thrown on; so does a request to stop (stop_request.h), as Stopped.
void ForEachIndex(std::int64_t n, int num_threads, const std::function<void(std::int64_t)>& work);

// `num_threads`, or where it is 0 the number of cores.
int NumThreads(int num_threads);

}  // namespace rcme
