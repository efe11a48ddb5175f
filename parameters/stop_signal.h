// The request of a signal (Ctrl-C) that the program stops, for every room that waits for something outside of
// it. Handlers and exit codes are those of experiments/core/work/stop_request.h.
#pragma once

#include <atomic>
#include <stdexcept>
#include <string>

namespace rcme {

inline std::atomic<int> stop_signal = 0;  // its number; 0: none has come
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may use nothing else");

// Work that ended because of a request to stop. What was cut off has no outcome.
class Stopped : public std::runtime_error {
 public:
  explicit Stopped(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace rcme
