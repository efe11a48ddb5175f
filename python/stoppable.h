#pragma once

#include <pybind11/pybind11.h>

#include <csignal>
#include <mutex>
#include <optional>

#include "experiments/core/work/stop_request.h"

namespace rcme {

// While an object lives, signals are stop requests. Several may live at a time: Python threads may call in
// parallel, and a Python function called from a call may call again.
class StopShared {
 public:
  StopShared() {
    const std::scoped_lock lock(mutex_);
    if (num_users_++ == 0) stop_.emplace(2);  // a session of Python is dear: only the third ends it
  }
  ~StopShared() {
    const std::scoped_lock lock(mutex_);
    if (--num_users_ > 0) return;
    stop_.reset();
    stop_signal = 0;  // does not stop the next call
  }
  StopShared(const StopShared&) = delete;
  StopShared& operator=(const StopShared&) = delete;

 private:
  static inline std::mutex mutex_;
  static inline int num_users_ = 0;
  static inline std::optional<StopOnSignals> stop_;
};

// Runs work that may be stopped: Ctrl-C becomes a Python exception after the finished part is saved.
template <typename Work>
auto RunStoppable(Work work) {
  const StopShared stop;
  try {
    const pybind11::gil_scoped_release unlocked;
    return work();
  } catch (const Stopped& stopped) {
    const bool is_interrupt = StopExitCode() == 128 + SIGINT;
    PyErr_SetString(is_interrupt ? PyExc_KeyboardInterrupt : PyExc_SystemExit, stopped.what());
    throw pybind11::error_already_set();
  }
}

}  // namespace rcme
