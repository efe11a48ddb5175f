// A process that answers lines with lines.
#pragma once

#include <chrono>
#include <string>

#include "peers/process_keeper.h"

namespace rcme {

// `sh -c command` in the working directory, its standard input and output held by this object, its messages
// where ours go. It is killed when this object or the program ends, with all that it has started, in whatever
// session.
class ChildProcess {
 public:
  // Throws NoOutsideAnswer (no_answer) if the system has no process to give.
  ChildProcess(ProcessKeeper* keeper, const std::string& command);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  // Sends the line, which ends with \n, and gives the one that comes back, without its end. Throws
  // NoOutsideAnswer: timed_out; no_answer where the process has ended; unreadable_answer where it has written
  // something since the answer before, says more than one line or none of a length that can be an answer's.
  // Throws Stopped soon after a signal has asked for it. After that this object is of no more use.
  std::string Ask(const std::string& line, std::chrono::steady_clock::time_point deadline);

  // For who is in no hurry: its input ends, and it may end by itself until the deadline.
  void CloseInput();
  void WaitForEnd(std::chrono::steady_clock::time_point deadline);

 private:
  void ThrowWrittenUnasked();
  [[noreturn]] void ThrowEnded();
  bool Send(const std::string& line, size_t* num_sent);  // false: the other end is closed
  bool Receive(std::string* received);                   // false: the other end is closed

  int input_ = -1, output_ = -1;  // of the process: what we write to and read from
  int lifeline_ = -1;             // process_keeper.h
};

}  // namespace rcme
