#pragma once

#include <pybind11/pybind11.h>

#include <csignal>

#include "experiments/core/work/stop_request.h"

namespace rcme {

// Work that may be stopped: Ctrl-C is an exception of Python once what is in hand is kept.
template <typename Work>
auto RunStoppable(Work work) {
  const StopOnSignals stop;
  try {
    const pybind11::gil_scoped_release unlocked;
    return work();
  } catch (const Stopped& stopped) {
    const bool is_interrupt = StopExitCode() == 128 + SIGINT;
    stop_signal = 0;  // the next call is not stopped by it
    PyErr_SetString(is_interrupt ? PyExc_KeyboardInterrupt : PyExc_SystemExit, stopped.what());
    throw pybind11::error_already_set();
  }
}

}  // namespace rcme
