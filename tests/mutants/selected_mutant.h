// Which mutant of a mutant build is on, and which ones a process has reached. Only sources that
// tests/mutants/weave.py has rewritten include this.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdlib>

// Both forms of an expression stand side by side, so that some are longer than what warnings would have.
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"

namespace rcme::mutants {

// The environment: RCME_MUTANT=<number of the mutant that is on>, RCME_MUTANT_TRACE=<file whose byte i
// becomes 1 as soon as mutant i is reached>. The file is mapped into memory when the program starts, so that
// it also receives what is reached by forked processes, which may neither open nor write files, and by
// processes that are killed.
class Selection {
 public:
  Selection() {
    if (const char* number = std::getenv("RCME_MUTANT")) selected_ = std::atoi(number);
    if (const char* file = std::getenv("RCME_MUTANT_TRACE")) MapTrace(file);
  }
  bool IsOn(int number) {
    if (reached_) (*reached_)[static_cast<std::size_t>(number)].store(1, std::memory_order_relaxed);
    return number == selected_;
  }

 private:
  using Reached = std::array<std::atomic<unsigned char>, 65536>;

  void MapTrace(const char* path) {
    const int file = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (file < 0 || ftruncate(file, sizeof(Reached)) != 0) std::abort();
    void* mapped = mmap(nullptr, sizeof(Reached), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (mapped == MAP_FAILED) std::abort();
    close(file);
    reached_ = static_cast<Reached*>(mapped);
  }

  int selected_ = -1;
  Reached* reached_ = nullptr;
};

inline Selection& TheSelection() {
  static Selection selection;
  return selection;
}
inline Selection& selection_at_start = TheSelection();

inline bool IsOn(int number) { return TheSelection().IsOn(number); }

}  // namespace rcme::mutants
