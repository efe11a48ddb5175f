#include "experiments/core/work/isolated_call.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <mutex>

#include "parameters/input_error.h"

namespace rcme {
namespace {

enum class MessageKind : char { kStep = 's', kResult = 'r' };

void WriteAll(int file, const void* bytes, size_t size) {
  const char* next = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t written = write(file, next, size);
    if (written < 0 && errno != EINTR) return;  // nobody reads
    if (written <= 0) continue;
    next += written;
    size -= static_cast<size_t>(written);
  }
}

// One letter, the length, the text.
void Send(int file, MessageKind kind, const std::string& text) {
  const auto size = static_cast<std::uint32_t>(text.size());
  std::string bytes(1, static_cast<char>(kind));
  bytes.append(reinterpret_cast<const char*>(&size), sizeof(size));
  WriteAll(file, (bytes + text).data(), bytes.size() + text.size());
}

[[noreturn]] void RunChild(const std::function<std::string(const Announce&)>& work, int file) noexcept {
  std::mutex mutex;
  const std::string result = work([&](const std::string& step) {
    const std::lock_guard lock(mutex);
    Send(file, MessageKind::kStep, step);
  });
  Send(file, MessageKind::kResult, result);
  _exit(0);
}

void SetLimit(decltype(RLIMIT_AS) resource, rlim_t most) {
  const rlimit limit{most, most};
  setrlimit(resource, &limit);
}

// What the child sends, taken apart as it comes.
class Receiver {
 public:
  // False at the end, or if nothing comes for that long (`is_late`).
  bool Receive(int file, double seconds, bool* is_late) {
    pollfd ready{file, POLLIN, 0};
    const int count = poll(&ready, 1, static_cast<int>(1e3 * seconds));
    *is_late = count == 0;
    if (count < 0 && errno == EINTR) return true;
    if (count <= 0) return false;
    char bytes[4096];
    const ssize_t size = read(file, bytes, sizeof(bytes));
    if (size < 0) return errno == EINTR;
    waiting_.append(bytes, static_cast<size_t>(size));
    TakeParts();
    return size > 0;
  }
  std::string last_step, result;
  bool has_result = false;

 private:
  void TakeParts() {
    constexpr size_t kHead = 1 + sizeof(std::uint32_t);
    std::uint32_t size = 0;
    for (; waiting_.size() >= kHead; waiting_.erase(0, kHead + size)) {
      std::memcpy(&size, waiting_.data() + 1, sizeof(size));
      if (waiting_.size() < kHead + size) return;
      const bool is_result = waiting_[0] == static_cast<char>(MessageKind::kResult);
      (is_result ? result : last_step) = waiting_.substr(kHead, size);
      has_result = has_result || is_result;
    }
  }
  std::string waiting_;
};

}  // namespace

IsolatedEnd RunIsolated(const std::function<std::string(const Announce&)>& work, double seconds_per_step) {
  int ends[2];
  std::fflush(nullptr);
  if (pipe(ends) != 0) throw InputError("no pipe can be made");
  const pid_t child = fork();
  if (child < 0) throw InputError("no process can be started");
  if (child == 0) {
    close(ends[0]);
    RunChild(work, ends[1]);
  }
  close(ends[1]);
  Receiver receiver;
  bool is_late = false;
  while (!receiver.has_result && receiver.Receive(ends[0], seconds_per_step, &is_late)) {
  }
  if (is_late) kill(child, SIGKILL);
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  using Kind = IsolatedEnd::Kind;
  IsolatedEnd end{Kind::kDone, 0, receiver.last_step, receiver.result};
  if (receiver.has_result) return end;
  end.kind = is_late ? Kind::kTimeout : WIFSIGNALED(status) ? Kind::kSignal : Kind::kExit;
  end.code = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
  return end;
}

void LimitProcess(size_t more_memory_bytes, int processor_seconds) {
  size_t num_pages = 0;
  std::ifstream("/proc/self/statm") >> num_pages;
  if (num_pages > 0)
    SetLimit(RLIMIT_AS, num_pages * static_cast<size_t>(sysconf(_SC_PAGESIZE)) + more_memory_bytes);
  SetLimit(RLIMIT_CPU, static_cast<rlim_t>(processor_seconds));
  SetLimit(RLIMIT_FSIZE, 0);
  SetLimit(RLIMIT_CORE, 0);
}

void ForbidOpeningFiles() { SetLimit(RLIMIT_NOFILE, 0); }

std::string DescribeEnd(const IsolatedEnd& end, double seconds_per_step) {
  switch (end.kind) {
    case IsolatedEnd::Kind::kDone:
      return "ended";
    case IsolatedEnd::Kind::kSignal:
      return fmt::format("ended the program by signal {} ({})", end.code, strsignal(end.code));
    case IsolatedEnd::Kind::kExit:
      return fmt::format("ended the program with exit code {}", end.code);
    case IsolatedEnd::Kind::kTimeout:
      return fmt::format("has not returned within {:g} s", seconds_per_step);
  }
  return "";
}

}  // namespace rcme
