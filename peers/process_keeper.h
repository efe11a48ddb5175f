// Starts commands such that nothing of them outlives this program, however it ends.
//
//   this program -> keeper -> supervisor -> sh -c command -> whatever it starts
//
// The keeper is forked once. It forks a supervisor for each command, so that no copy of a large program is
// made for every start. A supervisor holds one end of a lifeline, this program the other. Once the lifeline
// is closed, also by a SIGKILL of this program, the supervisor kills all that its command has started: as
// subreaper of its descendants (prctl(2)) it is the parent of those whose own parents have ended, in whatever
// session they are.
#pragma once

#include <sys/types.h>

#include <array>
#include <mutex>
#include <string>

namespace rcme {

class ProcessKeeper {
 public:
  ProcessKeeper() = default;  // forks with the first start: working directory and environment are of then
  ~ProcessKeeper();           // kills all that is left
  ProcessKeeper(const ProcessKeeper&) = delete;
  ProcessKeeper& operator=(const ProcessKeeper&) = delete;

  // Starts `sh -c command` with these standard streams, its messages where ours go, in a process group of its
  // own, signals as a new program expects them. Gives the lifeline, which is to be closed: it sends the
  // shell's status of waitpid as an int when the shell ends, and ends when nothing is left of all that it
  // started. Throws NoOutsideAnswer (no_answer) if the system has no process to give.
  int Start(const std::string& command, int input, int output);

 private:
  void Fork();
  bool Send(const std::string& command, const std::array<int, 3>& files);

  std::mutex mutex_;   // of what follows
  int requests_ = -1;  // -1: there is no keeper
  pid_t keeper_ = -1;
};

}  // namespace rcme
