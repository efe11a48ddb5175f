// Which mutant of a mutant build is on, and which ones a process has reached. Only sources that
// tests/mutants/weave.py has rewritten include this.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <string>

// Both forms of an expression stand side by side, so that some are longer than what warnings would have.
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"

namespace rcme::mutants {

// The environment: RCME_MUTANT=<number of the mutant that is on>, RCME_MUTANT_TRACE=<file that the numbers of
// the reached ones are added to when the process ends>.
class Selection {
 public:
  Selection() {
    if (const char* number = std::getenv("RCME_MUTANT")) selected_ = std::atoi(number);
    if (const char* file = std::getenv("RCME_MUTANT_TRACE")) trace_file_ = file;
  }
  ~Selection() {
    std::string lines;
    for (std::size_t i = 0; i < reached_.size(); ++i) {
      if (reached_[i]) lines += std::to_string(i) + "\n";
    }
    if (trace_file_.empty() || lines.empty()) return;
    const int file = open(trace_file_.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    if (file < 0 || write(file, lines.data(), lines.size()) < 0) std::abort();
    close(file);
  }
  bool IsOn(int number) {
    if (!trace_file_.empty())
      reached_[static_cast<std::size_t>(number)].store(true, std::memory_order_relaxed);
    return number == selected_;
  }

 private:
  int selected_ = -1;
  std::string trace_file_;
  std::array<std::atomic<bool>, 65536> reached_{};
};

inline bool IsOn(int number) {
  static Selection selection;
  return selection.IsOn(number);
}

}  // namespace rcme::mutants
