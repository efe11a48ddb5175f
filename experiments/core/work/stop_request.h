// Treats Ctrl-C (SIGINT), SIGTERM and the end of a time limit as a request: the items in progress are
// finished and kept, then the program ends. A signal also cuts off a wait for an estimator outside the
// program (parameters/stop_signal.h). The same signal a second time ends the program at once.
#pragma once

#include <chrono>
#include <csignal>

#include "parameters/stop_signal.h"

namespace rcme {

// While one lives, the two signals are requests, and a reader of the messages that goes away (SIGPIPE) is no
// reason to end. A signal that was ignored before (nohup) stays so. One at a time.
class StopOnSignals {
 public:
  StopOnSignals();
  ~StopOnSignals();
  StopOnSignals(const StopOnSignals&) = delete;
  StopOnSignals& operator=(const StopOnSignals&) = delete;

 private:
  struct sigaction interrupt_before_, terminate_before_, pipe_before_;
};

// From now on, while the StopOnSignals lives that there is: the request comes by itself after this time.
void StopAfter(std::chrono::duration<double> time);

// Whether one has come; the work looks between one piece and the next.
bool IsStopRequested();

// 128 + the signal's number: 130 after Ctrl-C, 143 after SIGTERM. 75, "try again" (EX_TEMPFAIL), after a time
// limit.
inline constexpr int kTryAgain = 75;
int StopExitCode();

}  // namespace rcme
