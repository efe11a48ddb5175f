// Treats Ctrl-C (SIGINT), SIGTERM and the end of a time limit as a request to stop: the program finishes and
// keeps the items in progress, then ends. A signal also interrupts a wait for an external estimator
// (parameters/stop_signal.h). The same signal once more ends the program at once.
#pragma once

#include <chrono>
#include <csignal>

#include "parameters/stop_signal.h"

namespace rcme {

// During its lifetime SIGINT and SIGTERM are requests to stop, and SIGPIPE is ignored: a reader of the
// messages that goes away does not end the program. SIGINT or SIGTERM stays ignored if it was before (nohup).
// At most one object may exist at a time.
class StopOnSignals {
 public:
  // `num_requests`: of each signal, before the next one ends the program; 1 or 2.
  explicit StopOnSignals(int num_requests = 1);
  ~StopOnSignals();
  StopOnSignals(const StopOnSignals&) = delete;
  StopOnSignals& operator=(const StopOnSignals&) = delete;

 private:
  struct sigaction interrupt_before_, terminate_before_, pipe_before_;
};

// Requests a stop after this time from now, if the present StopOnSignals still exists then.
void StopAfter(std::chrono::duration<double> time);

// Whether a stop was requested; to be called between items of work.
bool IsStopRequested();

// 128 + the signal's number: 130 after Ctrl-C, 143 after SIGTERM. After a time limit 75, "try again"
// (EX_TEMPFAIL).
inline constexpr int kTryAgain = 75;
int StopExitCode();

}  // namespace rcme
