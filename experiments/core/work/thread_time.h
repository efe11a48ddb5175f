#pragma once

#include <ctime>

namespace rcme {

inline double ReadClock(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Processor time (s) of this thread and of the whole process, from an arbitrary origin.
inline double ThreadSeconds() { return ReadClock(CLOCK_THREAD_CPUTIME_ID); }
inline double ProcessSeconds() { return ReadClock(CLOCK_PROCESS_CPUTIME_ID); }

}  // namespace rcme
