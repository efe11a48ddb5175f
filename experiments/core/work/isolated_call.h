// Runs work in its own process, so that a crash, an exit or an endless loop in foreign code is an outcome.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace rcme {

// Names the step that begins; callable from several threads.
using Announce = std::function<void(const std::string& step)>;

struct IsolatedEnd {
  enum class Kind { kDone, kSignal, kExit, kTimeout };
  Kind kind = Kind::kDone;
  int code = 0;           // the signal's number, or the exit code
  std::string last_step;  // the last that was announced
  std::string result;     // what the work returned, if it is done
};

// Calls `work` in a child of this process and ends the child if no step is announced for `seconds_per_step`.
// The child shares nothing with this process but what was in memory before. To be called where no other
// thread runs. An exception from `work` ends the child by SIGABRT.
IsolatedEnd RunIsolated(const std::function<std::string(const Announce&)>& work, double seconds_per_step);

// For `work` on what nobody vouches for. Limits this process: to so much memory beyond what it has, to so
// many seconds of processor time; no file is written, and none when it ends by a signal.
void LimitProcess(size_t more_memory_bytes, int processor_seconds);
// From now on this process opens no file, pipe or socket, whatever its input makes a library do.
void ForbidOpeningFiles();

// How it ended, as part of a sentence: "ended the program by signal 11 (Segmentation fault)".
std::string DescribeEnd(const IsolatedEnd& end, double seconds_per_step);

}  // namespace rcme
