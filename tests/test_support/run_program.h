// Runs a program as a user would: arguments in; exit code, standard output and standard error out.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/test_support/paths.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {

struct ProgramResult {
  int exit_code = -1;  // 128 + signal if a signal ended it
  std::string out, err;
};

// A program on its way. Its output goes to files in a folder of its own, so that no pipe can fill up.
class RunningProgram {
 public:
  explicit RunningProgram(std::vector<std::string> command) {
    std::vector<char*> arguments;
    for (std::string& word : command) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const std::string out = folder_.Path("out"), err = folder_.Path("err");
    pid_ = fork();
    if (pid_ < 0) throw std::runtime_error("cannot fork");
    if (pid_ > 0) return;
    const int out_file = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int err_file = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int null_file = open("/dev/null", O_RDONLY);
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);  // as in a terminal
    dup2(null_file, STDIN_FILENO);
    dup2(out_file, STDOUT_FILENO);
    dup2(err_file, STDERR_FILENO);
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  ~RunningProgram() {
    if (pid_ > 0) Kill();
  }
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  bool HasEnded() {
    if (pid_ > 0 && waitpid(pid_, &status_, WNOHANG) == pid_) pid_ = 0;
    return pid_ == 0;
  }
  void Send(int signal) {
    if (!HasEnded()) kill(pid_, signal);
  }
  void Kill() {
    if (HasEnded()) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, &status_, 0);
    pid_ = 0;
  }
  // Waits for the end; a program that takes longer than `limit` is killed (exit code 137).
  ProgramResult Wait(std::chrono::seconds limit = std::chrono::seconds(120)) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (!HasEnded() && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    Kill();
    const int code = WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
    return {code, ReadBytes(folder_.Path("out")), ReadBytes(folder_.Path("err"))};
  }

 private:
  TempFolder folder_;
  pid_t pid_ = 0;
  int status_ = 0;
};

// The built program with these arguments.
inline std::vector<std::string> RcmeCommand(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), ProgramPath());
  return arguments;
}

inline ProgramResult RunRcme(const std::vector<std::string>& arguments) {
  return RunningProgram(RcmeCommand(arguments)).Wait();
}

// A line of shell, for redirections and limits; the program is "$RCME" in it.
inline ProgramResult RunShell(const std::string& line) {
  return RunningProgram({"/bin/sh", "-c", "RCME='" + ProgramPath() + "'\n" + line}).Wait();
}

}  // namespace rcme
