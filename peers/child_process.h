// A process that answers each line with a line.
#pragma once

#include <chrono>
#include <string>

#include "peers/process_keeper.h"

namespace rcme {

// Runs `sh -c command` in the working directory. This object holds its standard input and output; its
// standard error is the program's. It is killed when this object or the program ends, together with all
// processes that it has started, in whatever session.
class ChildProcess {
 public:
  // Throws NoOutsideAnswer (no_answer) if the system cannot start a process.
  ChildProcess(ProcessKeeper* keeper, const std::string& command);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  // Sends the line, which must end with \n, and returns the answer without its line end. Throws
  // NoOutsideAnswer: timed_out; no_answer if the process has ended; unreadable_answer if it wrote something
  // after its previous answer, or answers with several lines or a line too long for an answer. Throws Stopped
  // soon after a stop signal. After an exception this object must not be used again.
  std::string Ask(const std::string& line, std::chrono::steady_clock::time_point deadline);

  // For a graceful end: close its input, then wait until it ends or the deadline.
  void CloseInput();
  void WaitForEnd(std::chrono::steady_clock::time_point deadline);

 private:
  void ThrowWrittenUnasked();
  [[noreturn]] void ThrowEnded();
  bool Send(const std::string& line, size_t* num_sent);  // false: the other end is closed
  bool Receive(std::string* received);                   // false: the other end is closed

  int input_ = -1, output_ = -1;  // our ends of its standard input and output
  int lifeline_ = -1;             // process_keeper.h
};

}  // namespace rcme
