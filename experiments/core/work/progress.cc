#include "experiments/core/work/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "experiments/core/text/message.h"

namespace rcme {

Progress::Progress(std::string unit, std::int64_t total, std::int64_t num_done_before)
    : unit_(std::move(unit)),
      total_(total),
      num_done_before_(num_done_before),
      done_(num_done_before),
      is_terminal_(isatty(STDERR_FILENO) == 1),
      interval_(is_terminal_ ? 200 : 5000),
      start_(Clock::now()),
      next_print_(start_ + std::max(interval_, std::chrono::milliseconds(1000))) {
  if (num_done_before > 0)
    PrintMessage("{} of {} {} are there already, {} are left\n", num_done_before, total, unit_,
                 total - num_done_before);
}

Progress::~Progress() {
  if (!has_printed_) return;
  if (is_terminal_) {
    Print(Clock::now());
    WriteMessage("\n");
  }
}

void Progress::Advance(std::int64_t count) {
  done_ += count;
  const Clock::time_point now = Clock::now();
  if (now < next_print_.load(std::memory_order_relaxed)) return;
  const std::unique_lock lock(print_mutex_, std::try_to_lock);
  if (!lock || now < next_print_.load()) return;  // another thread prints, or has just done so
  next_print_ = now + interval_;
  has_printed_ = true;
  Print(now);
}

void Progress::Print(Clock::time_point now) {
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const std::int64_t done = done_;
  const double rate = static_cast<double>(done - num_done_before_) / elapsed;
  const double seconds_left = rate > 0.0 ? static_cast<double>(total_ - done) / rate : 0.0;
  const std::string line = fmt::format("{} / {} {} ({:.0f} %), {:.3g} per second, {} left", done, total_,
                                       unit_, 100.0 * static_cast<double>(done) / static_cast<double>(total_),
                                       rate, DescribeDuration(seconds_left));
  if (is_terminal_) {
    PrintMessage("\r{:<79}", line);
  } else {
    PrintMessage("{}\n", line);
  }
}

std::string DescribeDuration(double seconds) {
  const auto whole = static_cast<long long>(std::ceil(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace rcme
