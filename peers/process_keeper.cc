#include "peers/process_keeper.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include "peers/outside_answer.h"

namespace rcme {
namespace {

constexpr size_t kMaxCommandBytes = size_t{1} << 17;  // Linux accepts no longer ones (MAX_ARG_STRLEN)
constexpr int kRequests = 3;                          // file descriptor of the keeper's end
constexpr std::chrono::seconds kKeeperTimeToKill{2};

[[noreturn]] void ThrowNoProcess(const char* what) {
  throw NoOutsideAnswer(MotionStatus::kNoAnswer,
                        fmt::format("no process can be started: {}: {}", what, std::strerror(errno)));
}

using Files = std::array<int, 3>;  // input and output of the shell, its supervisor's end of the lifeline

// A message that carries the three files.
struct Request {
  explicit Request(void* bytes, size_t size) : text{bytes, size} {
    header.msg_iov = &text;
    header.msg_iovlen = 1;
    header.msg_control = control.data();
    header.msg_controllen = control.size();
  }
  iovec text;
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(Files))> control{};
  msghdr header{};
};

// The functions down to Keep run in forks of a program that may have threads: they use system calls only and
// allocate no memory.

[[noreturn]] void RunShell(const char* command, const Files& files) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // when the supervisor ends
  dup2(files[0], STDIN_FILENO);
  dup2(files[1], STDOUT_FILENO);
  for (const int number : {SIGPIPE, SIGXFSZ, SIGINT, SIGTERM}) signal(number, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  execl("/bin/sh", "sh", "-c", command, nullptr);
  _exit(127);
}

// Sends SIGKILL to every child. False if the system does not list the children.
bool KillChildren() {
  const int file = open("/proc/thread-self/children", O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  std::array<char, 4096> digits;  // the others are listed once these are gone
  const ssize_t count = read(file, digits.data(), digits.size());
  close(file);
  pid_t child = 0;
  for (ssize_t i = 0; i < count; ++i) {
    const char digit = digits[static_cast<size_t>(i)];
    if (digit >= '0' && digit <= '9') {
      child = 10 * child + (digit - '0');
      continue;
    }
    if (child > 0) kill(child, SIGKILL);  // not reaped yet, so the number is not reused
    child = 0;
  }
  return true;
}

// Kills the children until none is left. Grandchildren become children as soon as their parents have ended.
void EndDescendants(pid_t shell) {
  while (true) {
    if (!KillChildren() && shell > 0) kill(-shell, SIGKILL);
    pid_t ended = 0;
    while ((ended = waitpid(-1, nullptr, WNOHANG)) > 0) {
    }
    if (ended < 0 && errno == ECHILD) return;
    const timespec pause{0, 500'000};
    nanosleep(&pause, nullptr);
  }
}

// Reaps ended children and passes on the status of the shell. False: no child is left.
bool ReapEnded(pid_t shell, int lifeline) {
  int status = 0;
  pid_t ended = 0;
  while ((ended = waitpid(-1, &status, WNOHANG)) > 0) {
    if (ended == shell) send(lifeline, &status, sizeof(status), MSG_NOSIGNAL);
  }
  return ended == 0;
}

[[noreturn]] void Supervise(const char* command, const Files& files) {
  close(kRequests);
  signal(SIGCHLD, SIG_DFL);
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  sigset_t of_children;
  sigemptyset(&of_children);
  sigaddset(&of_children, SIGCHLD);
  const int ends = signalfd(-1, &of_children, SFD_CLOEXEC | SFD_NONBLOCK);
  const pid_t shell = fork();
  if (shell == 0) RunShell(command, files);
  if (shell < 0) _exit(1);
  const int lifeline = files[2];
  for (const int stream : {files[0], files[1]}) close(stream);
  std::array<pollfd, 2> events = {{{lifeline, POLLIN, 0}, {ends, POLLIN, 0}}};
  while (poll(events.data(), events.size(), -1) > 0 && events[0].revents == 0) {
    signalfd_siginfo which;
    while (read(ends, &which, sizeof(which)) > 0) {
    }
    if (!ReapEnded(shell, lifeline)) _exit(0);
  }
  EndDescendants(shell);
  _exit(0);
}

// Detaches from the program's signals, terminal and files, except for the requests and standard error.
void LeaveProgram(int requests) {
  setsid();
  sigset_t all;
  sigfillset(&all);
  sigprocmask(SIG_SETMASK, &all, nullptr);
  signal(SIGCHLD, SIG_IGN);  // supervisors need no waitpid
  prctl(PR_SET_NAME, "process-keeper");
  prctl(PR_SET_CHILD_SUBREAPER, 1);  // adopts descendants of a killed supervisor
  dup3(requests, kRequests, O_CLOEXEC);
  if (close_range(kRequests + 1, ~0U, 0) != 0) {
    for (int file = kRequests + 1; file < 65536; ++file) close(file);
  }
  const int null_file = open("/dev/null", O_RDWR | O_CLOEXEC);
  dup2(null_file, STDIN_FILENO);
  dup2(null_file, STDOUT_FILENO);
  close(null_file);
}

[[noreturn]] void Keep(int requests) {
  static std::array<char, kMaxCommandBytes> command;
  LeaveProgram(requests);
  while (true) {
    Request request(command.data(), command.size());
    const ssize_t size = recvmsg(kRequests, &request.header, MSG_CMSG_CLOEXEC);
    if (size <= 0) break;
    Files files;
    std::memcpy(files.data(), CMSG_DATA(CMSG_FIRSTHDR(&request.header)), sizeof(files));
    if (fork() == 0) Supervise(command.data(), files);
    for (const int file : files) close(file);
  }
  EndDescendants(-1);
  _exit(0);
}

}  // namespace

ProcessKeeper::~ProcessKeeper() {
  if (requests_ < 0) return;
  close(requests_);
  const auto deadline = std::chrono::steady_clock::now() + kKeeperTimeToKill;
  while (waitpid(keeper_, nullptr, WNOHANG) == 0 && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

int ProcessKeeper::Start(const std::string& command, int input, int output) {
  if (command.size() >= kMaxCommandBytes)
    throw NoOutsideAnswer(MotionStatus::kNoAnswer, "the command is too long for the system");
  std::array<int, 2> lifeline{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, lifeline.data()) != 0)
    ThrowNoProcess("socketpair");
  const Files files = {input, output, lifeline[1]};
  const std::lock_guard lock(mutex_);
  try {
    if (requests_ < 0) Fork();
    if (!Send(command, files)) {  // the keeper was killed
      close(requests_);
      waitpid(keeper_, nullptr, WNOHANG);
      Fork();
      if (!Send(command, files)) ThrowNoProcess("sendmsg");
    }
  } catch (...) {
    for (const int end : lifeline) close(end);
    throw;
  }
  close(lifeline[1]);
  return lifeline[0];
}

void ProcessKeeper::Fork() {
  requests_ = -1;
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) ThrowNoProcess("socketpair");
  keeper_ = fork();
  if (keeper_ == 0) {
    close(ends[0]);
    Keep(ends[1]);
  }
  close(ends[1]);
  if (keeper_ < 0) {
    close(ends[0]);
    ThrowNoProcess("fork");
  }
  requests_ = ends[0];
}

bool ProcessKeeper::Send(const std::string& command, const Files& files) {
  std::string text = command;
  Request request(text.data(), text.size() + 1);  // with the terminating zero
  cmsghdr* control = CMSG_FIRSTHDR(&request.header);
  control->cmsg_level = SOL_SOCKET;
  control->cmsg_type = SCM_RIGHTS;
  control->cmsg_len = CMSG_LEN(sizeof(files));
  std::memcpy(CMSG_DATA(control), files.data(), sizeof(files));
  return sendmsg(requests_, &request.header, MSG_NOSIGNAL) >= 0;
}

}  // namespace rcme
