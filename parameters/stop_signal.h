// The stop request of a signal (Ctrl-C), for every room that waits for something outside of the program. The
// handlers and exit codes are in experiments/core/work/stop_request.h.
#pragma once

#include <atomic>
#include <stdexcept>
#include <string>

namespace rcme {

inline std::atomic<int> stop_signal = 0;  // number of the signal; 0: none
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may use nothing else");

// Thrown by work that ended on a stop request; the interrupted part has no outcome.
class Stopped : public std::runtime_error {
 public:
  explicit Stopped(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace rcme
