#pragma once

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <string>

namespace rcme {

// Makes standard error a terminal, until it is read.
class ErrorTerminal {
 public:
  ErrorTerminal() : reader_(posix_openpt(O_RDWR | O_NOCTTY)) {
    std::array<char, 64> name{};
    if (reader_ < 0 || grantpt(reader_) != 0 || unlockpt(reader_) != 0 ||
        ptsname_r(reader_, name.data(), name.size()) != 0)
      return;
    terminal_ = open(name.data(), O_RDWR | O_NOCTTY);
    if (terminal_ < 0) return;
    before_ = dup(STDERR_FILENO);
    dup2(terminal_, STDERR_FILENO);
  }
  ~ErrorTerminal() {
    Restore();
    if (terminal_ >= 0) close(terminal_);
    if (reader_ >= 0) close(reader_);
  }
  ErrorTerminal(const ErrorTerminal&) = delete;
  ErrorTerminal& operator=(const ErrorTerminal&) = delete;

  // False: the machine has no pseudo terminals.
  bool is_there() const { return before_ >= 0; }

  // What was written so far; some thousand characters fit.
  std::string Read() {
    Restore();
    std::string text;
    pollfd waiting{reader_, POLLIN, 0};
    while (poll(&waiting, 1, kPauseMs) > 0) {
      std::array<char, 4096> part{};
      const ssize_t size = read(reader_, part.data(), part.size());
      if (size <= 0) break;
      text.append(part.data(), static_cast<size_t>(size));
    }
    return text;
  }

 private:
  static constexpr int kPauseMs = 200;  // what was written arrives well within this time

  void Restore() {
    if (before_ < 0) return;
    dup2(before_, STDERR_FILENO);
    close(before_);
    before_ = -1;
  }

  int reader_, terminal_ = -1, before_ = -1;
};

}  // namespace rcme
