// A process that answers lines with lines.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>

namespace rcme {

// `sh -c command` in the working directory, its standard input and output held by this object, its messages
// where ours go. Ends with this object: it is given a moment after its input has ended, then killed with what
// it has started.
class ChildProcess {
 public:
  // Throws NoOutsideAnswer (no_answer) if the system has no process to give.
  explicit ChildProcess(const std::string& command);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  // Sends the line, which ends with \n, and gives the one that comes back, without its end. Throws
  // NoOutsideAnswer: timed_out; no_answer where the process has ended; unreadable_answer where it says more
  // than one line or none of a length that can be an answer's. After that this object is of no more use.
  std::string Ask(const std::string& line, std::chrono::steady_clock::time_point deadline);

 private:
  [[noreturn]] void ThrowEnded();
  bool Receive(std::string* received);  // false: the other end is closed

  pid_t process_ = -1;
  int socket_ = -1;
};

}  // namespace rcme
