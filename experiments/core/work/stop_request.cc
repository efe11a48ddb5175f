#include "experiments/core/work/stop_request.h"

#include <atomic>

namespace rcme {
namespace {

using Clock = std::chrono::steady_clock;

std::atomic<Clock::time_point> time_limit = Clock::time_point::max();

void Note(int signal) { stop_signal = signal; }

// The next one has the default action.
void HandleOnce(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigaction(signal, &action, nullptr);
}

void NoteAndOnceMore(int signal) {
  Note(signal);
  HandleOnce(signal, Note);
}

void Handle(int signal, int num_requests, struct sigaction* before) {
  sigaction(signal, nullptr, before);
  if (before->sa_handler != SIG_IGN) HandleOnce(signal, num_requests > 1 ? NoteAndOnceMore : Note);
}

}  // namespace

StopOnSignals::StopOnSignals(int num_requests) {
  stop_signal = 0;
  time_limit = Clock::time_point::max();
  Handle(SIGINT, num_requests, &interrupt_before_);
  Handle(SIGTERM, num_requests, &terminate_before_);
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, &pipe_before_);
}

StopOnSignals::~StopOnSignals() {
  time_limit = Clock::time_point::max();
  sigaction(SIGINT, &interrupt_before_, nullptr);
  sigaction(SIGTERM, &terminate_before_, nullptr);
  sigaction(SIGPIPE, &pipe_before_, nullptr);
}

void StopAfter(std::chrono::duration<double> time) {
  time_limit = Clock::now() + std::chrono::duration_cast<Clock::duration>(time);
}

bool IsStopRequested() {
  const Clock::time_point limit = time_limit;
  return stop_signal != 0 || (limit != Clock::time_point::max() && Clock::now() >= limit);
}

int StopExitCode() { return stop_signal != 0 ? 128 + stop_signal : kTryAgain; }

}  // namespace rcme
