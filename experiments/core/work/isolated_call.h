// Runs work in its own process. A crash, an exit or an endless loop of foreign code is then an outcome that
// the caller can report.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace rcme {

// Announces by name the step that begins; callable from several threads.
using Announce = std::function<void(const std::string& step)>;

struct IsolatedEnd {
  enum class Kind { kDone, kSignal, kExit, kTimeout };
  Kind kind = Kind::kDone;
  int code = 0;           // the signal's number, or the exit code
  std::string last_step;  // the last step announced
  std::string result;     // the value that the work returned, for kDone
};

// Calls `work` in a child process, a fork of this one, and kills the child if it announces no step for
// `seconds_per_step`. The child has a copy of this process's memory; changes do not come back. No other
// thread may run at the call. An exception from `work` ends the child by SIGABRT. Throws InputError if no
// process can be started.
IsolatedEnd RunIsolated(const std::function<std::string(const Announce&)>& work, double seconds_per_step);

// For `work` on untrusted input. Limits this process to `more_memory_bytes` beyond its present address space
// and to `processor_seconds`, and forbids it to write files, core dumps included.
void LimitProcess(size_t more_memory_bytes, int processor_seconds);
// Forbids this process to open files, pipes and sockets from now on, also within libraries.
void ForbidOpeningFiles();

// Describes the end as part of a sentence: "ended the program by signal 11 (Segmentation fault)".
std::string DescribeEnd(const IsolatedEnd& end, double seconds_per_step);

}  // namespace rcme
