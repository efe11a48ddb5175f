#include "peers/child_process.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <initializer_list>

#include "parameters/plain_text.h"
#include "parameters/stop_signal.h"
#include "peers/outside_answer.h"

namespace rcme {
namespace {

using Clock = std::chrono::steady_clock;

constexpr size_t kMaxAnswerBytes = size_t{1} << 26;
constexpr std::chrono::milliseconds kTimeToTell{500};   // to report how it ended
constexpr std::chrono::milliseconds kTimeToKill{2000};  // to kill it and all that it has started
constexpr int kStopLook_ms = 100;                       // interval of checks for a stop request

int MillisecondsUntil(Clock::time_point deadline) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, 1'000'000'000));
}

// Waits for input or the end of the stream. False: neither came before the deadline.
bool WaitToRead(int file, Clock::time_point deadline) {
  pollfd event{file, POLLIN, 0};
  int num_ready = 0;
  do num_ready = poll(&event, 1, MillisecondsUntil(deadline));
  while (num_ready < 0 && errno == EINTR);
  return num_ready > 0;
}

std::string DescribeEnd(int status) {
  return WIFSIGNALED(status) ? fmt::format("ended by signal {}", WTERMSIG(status))
                             : fmt::format("ended with exit code {}", WEXITSTATUS(status));
}

}  // namespace

ChildProcess::ChildProcess(ProcessKeeper* keeper, const std::string& command) {
  std::array<int, 2> input{-1, -1}, output{-1, -1};  // our end, the process's end
  const auto make = [](std::array<int, 2>& ends) {
    return socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) == 0;
  };
  const auto close_all = [](std::initializer_list<int> files) {
    for (const int file : files) {
      if (file >= 0) close(file);
    }
  };
  try {
    if (!make(input) || !make(output))
      throw NoOutsideAnswer(MotionStatus::kNoAnswer, fmt::format("socketpair: {}", std::strerror(errno)));
    shutdown(input[0], SHUT_RD);  // one direction each, like pipes
    shutdown(output[0], SHUT_WR);
    lifeline_ = keeper->Start(command, input[1], output[1]);
  } catch (...) {
    close_all({input[0], input[1], output[0], output[1]});
    throw;
  }
  close_all({input[1], output[1]});
  input_ = input[0];
  output_ = output[0];
}

ChildProcess::~ChildProcess() {
  CloseInput();
  close(output_);
  shutdown(lifeline_, SHUT_WR);
  const Clock::time_point deadline = Clock::now() + kTimeToKill;
  int status = 0;
  while (WaitToRead(lifeline_, deadline) && recv(lifeline_, &status, sizeof(status), 0) > 0) {
  }
  close(lifeline_);
}

void ChildProcess::CloseInput() {
  if (input_ >= 0) close(input_);
  input_ = -1;
}

void ChildProcess::WaitForEnd(Clock::time_point deadline) { WaitToRead(lifeline_, deadline); }

std::string ChildProcess::Ask(const std::string& line, Clock::time_point deadline) {
  ThrowWrittenUnasked();
  std::string received;
  size_t num_sent = 0;
  size_t end = std::string::npos;
  bool is_input_open = true;
  while (end == std::string::npos) {
    if (stop_signal != 0) throw Stopped("stopped; nothing was written");
    const bool is_sending = num_sent < line.size();
    std::array<pollfd, 2> events = {
        {{output_, POLLIN, 0},
         {is_input_open ? input_ : -1, static_cast<short>(is_sending ? POLLOUT : 0), 0}}};
    const int num_ready =
        poll(events.data(), events.size(), std::min(MillisecondsUntil(deadline), kStopLook_ms));
    if (num_ready < 0 && errno == EINTR) continue;
    if (num_ready <= 0) {
      if (Clock::now() < deadline) continue;
      throw NoOutsideAnswer(MotionStatus::kTimedOut, "no answer in time");
    }
    if (events[0].revents != 0) {
      const size_t num_before = received.size();
      if (!Receive(&received)) ThrowEnded();
      end = received.find('\n', num_before);
      if (received.size() > kMaxAnswerBytes)
        throw NoOutsideAnswer(MotionStatus::kUnreadableAnswer, "a line too long for an answer");
    }
    if (events[1].revents != 0) {
      const bool is_lost = is_sending ? !Send(line, &num_sent) : (events[1].revents & POLLERR) != 0;
      // Output that it has written before is read first.
      if (is_lost && !WaitToRead(output_, Clock::now() + kTimeToTell)) ThrowEnded();
      if (!is_sending) is_input_open = false;  // everything is sent: stop polling its input
    }
    // Needed here too, as poll never times out while bytes keep coming.
    if (end == std::string::npos && Clock::now() >= deadline)
      throw NoOutsideAnswer(MotionStatus::kTimedOut, "no answer in time");
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

void ChildProcess::ThrowWrittenUnasked() {
  std::string received;
  Receive(&received);
  if (received.empty()) return;
  throw NoOutsideAnswer(MotionStatus::kUnreadableAnswer,
                        fmt::format("{} was written before the process was asked: one answer to one problem "
                                    "(other output belongs on standard error)",
                                    Quoted(received.substr(0, 80))));
}

bool ChildProcess::Send(const std::string& line, size_t* num_sent) {
  const ssize_t sent =
      send(input_, line.data() + *num_sent, line.size() - *num_sent, MSG_NOSIGNAL | MSG_DONTWAIT);
  if (sent > 0) *num_sent += static_cast<size_t>(sent);
  return sent >= 0 || errno == EAGAIN || errno == EINTR;
}

bool ChildProcess::Receive(std::string* received) {
  std::array<char, 65536> piece;
  const ssize_t count = recv(output_, piece.data(), piece.size(), MSG_DONTWAIT);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return true;
  if (count <= 0) return false;
  received->append(piece.data(), static_cast<size_t>(count));
  return true;
}

void ChildProcess::ThrowEnded() {
  int status = 0;
  const bool has_ended = WaitToRead(lifeline_, Clock::now() + kTimeToTell);
  if (!has_ended)
    throw NoOutsideAnswer(MotionStatus::kNoAnswer, "the process closed its standard input or output");
  const bool is_told = recv(lifeline_, &status, sizeof(status), MSG_DONTWAIT) == sizeof(status);
  throw NoOutsideAnswer(MotionStatus::kNoAnswer,
                        "the process " + (is_told ? DescribeEnd(status)
                                                  : "could not be started or was killed "
                                                    "with its supervisor"));
}

}  // namespace rcme
