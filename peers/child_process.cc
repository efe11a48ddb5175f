#include "peers/child_process.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <thread>

#include "parameters/plain_text.h"
#include "peers/outside_answer.h"

extern char** environ;

namespace rcme {
namespace {

using Clock = std::chrono::steady_clock;

constexpr size_t kMaxAnswerBytes = size_t{1} << 26;
constexpr std::chrono::milliseconds kTimeToEnd{500};

[[noreturn]] void ThrowNoProcess(const char* what) {
  throw NoOutsideAnswer(MotionStatus::kNoAnswer, fmt::format("{}: {}", what, std::strerror(errno)));
}

int MillisecondsUntil(Clock::time_point deadline) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, 1'000'000'000));
}

// Both ends of the child's input and output are one socket; a group of its own, so that Ctrl-C is ours to
// answer; signals as a new program expects them.
pid_t Spawn(const std::string& command, int its_end) {
  posix_spawn_file_actions_t streams;
  posix_spawn_file_actions_init(&streams);
  posix_spawn_file_actions_adddup2(&streams, its_end, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&streams, its_end, STDOUT_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, usual;
  sigemptyset(&none);
  sigemptyset(&usual);
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGINT, SIGTERM}) sigaddset(&usual, signal);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  std::array<std::string, 3> words = {"sh", "-c", command};
  const std::array<char*, 4> arguments = {words[0].data(), words[1].data(), words[2].data(), nullptr};
  pid_t process = -1;
  errno = posix_spawn(&process, "/bin/sh", &streams, &attributes, arguments.data(), environ);
  if (errno != 0) process = -1;
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&streams);
  return process;
}

// How it ended, in words; nothing: it has not within that time.
std::string WaitFor(pid_t process, std::chrono::milliseconds time) {
  const Clock::time_point deadline = Clock::now() + time;
  int status = 0;
  while (waitpid(process, &status, WNOHANG) != process) {
    if (Clock::now() >= deadline) return {};
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return WIFSIGNALED(status) ? fmt::format("ended by signal {}", WTERMSIG(status))
                             : fmt::format("ended with exit code {}", WEXITSTATUS(status));
}

}  // namespace

ChildProcess::ChildProcess(const std::string& command) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) ThrowNoProcess("socket");
  socket_ = ends[0];
  process_ = Spawn(command, ends[1]);
  close(ends[1]);
  if (process_ >= 0) return;
  close(socket_);
  ThrowNoProcess("sh");
}

ChildProcess::~ChildProcess() {
  close(socket_);
  if (process_ < 0) return;
  const bool has_ended = !WaitFor(process_, kTimeToEnd).empty();
  kill(-process_, SIGKILL);  // with what it has left behind
  if (!has_ended) waitpid(process_, nullptr, 0);
}

std::string ChildProcess::Ask(const std::string& line, Clock::time_point deadline) {
  std::string received;
  size_t num_sent = 0;
  size_t end = std::string::npos;
  while (end == std::string::npos) {
    pollfd event{socket_, static_cast<short>(num_sent < line.size() ? POLLIN | POLLOUT : POLLIN), 0};
    const int num_ready = poll(&event, 1, MillisecondsUntil(deadline));
    if (num_ready < 0 && errno == EINTR) continue;
    if (num_ready <= 0) throw NoOutsideAnswer(MotionStatus::kTimedOut, "no answer in time");
    if (event.revents & (POLLIN | POLLHUP | POLLERR)) {
      const size_t num_before = received.size();
      if (!Receive(&received)) ThrowEnded();
      end = received.find('\n', num_before);
      if (received.size() > kMaxAnswerBytes)
        throw NoOutsideAnswer(MotionStatus::kUnreadableAnswer, "a line too long for an answer");
    }
    if (event.revents & POLLOUT) {
      const ssize_t sent =
          send(socket_, line.data() + num_sent, line.size() - num_sent, MSG_NOSIGNAL | MSG_DONTWAIT);
      if (sent > 0) num_sent += static_cast<size_t>(sent);
    }
  }
  if (num_sent < line.size() || end + 1 < received.size()) {
    throw NoOutsideAnswer(MotionStatus::kUnreadableAnswer,
                          fmt::format("{} is not one answer to one problem (other output belongs on standard "
                                      "error)",
                                      Quoted(received.substr(0, 80))));
  }
  received.resize(end);
  return received;
}

bool ChildProcess::Receive(std::string* received) {
  std::array<char, 65536> piece;
  const ssize_t count = recv(socket_, piece.data(), piece.size(), MSG_DONTWAIT);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return true;
  if (count <= 0) return false;
  received->append(piece.data(), static_cast<size_t>(count));
  return true;
}

void ChildProcess::ThrowEnded() {
  const std::string how = WaitFor(process_, kTimeToEnd);
  if (how.empty()) throw NoOutsideAnswer(MotionStatus::kNoAnswer, "the process closed its standard output");
  kill(-process_, SIGKILL);
  process_ = -1;
  throw NoOutsideAnswer(MotionStatus::kNoAnswer, "the process " + how);
}

}  // namespace rcme
