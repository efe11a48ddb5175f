// Starts commands such that no process of theirs outlives this program, however it ends.
//
//   this program -> keeper -> supervisor -> sh -c command -> its descendants
//
// The keeper is forked once and forks a supervisor for each command, so a large program is not copied for
// every start. A supervisor holds one end of a lifeline, this program the other. When the lifeline closes,
// also by a SIGKILL of this program, the supervisor kills all descendants of its command. As subreaper
// (prctl(2)) it becomes the parent of descendants whose own parents have ended, in whatever session they are.
#pragma once

#include <sys/types.h>

#include <array>
#include <mutex>
#include <string>

namespace rcme {

class ProcessKeeper {
 public:
  ProcessKeeper() = default;  // forks at the first Start, with the environment of then
  ~ProcessKeeper();           // kills all remaining processes
  ProcessKeeper(const ProcessKeeper&) = delete;
  ProcessKeeper& operator=(const ProcessKeeper&) = delete;

  // Starts `sh -c command` with these standard streams, the program's standard error, its own process group
  // and default signal handling. Returns the lifeline, which the caller must close. It sends the shell's
  // waitpid status as an int when the shell ends, and closes when all descendants have ended. Throws
  // NoOutsideAnswer (no_answer) if the system cannot start a process.
  int Start(const std::string& command, int input, int output);

 private:
  void Fork();
  bool Send(const std::string& command, const std::array<int, 3>& files);

  std::mutex mutex_;   // guards the members below
  int requests_ = -1;  // -1: there is no keeper
  pid_t keeper_ = -1;
};

}  // namespace rcme
