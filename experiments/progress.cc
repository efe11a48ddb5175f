#include "experiments/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace rcme {

Progress::Progress(std::string unit, std::int64_t total)
    : unit_(std::move(unit)),
      total_(total),
      is_terminal_(isatty(STDERR_FILENO) == 1),
      start_(Clock::now()),
      last_print_(start_) {}

Progress::~Progress() {
  if (!has_printed_) return;
  if (is_terminal_) {
    Print(Clock::now());
    std::fputc('\n', stderr);
  }
}

void Progress::Advance(std::int64_t count) {
  done_ += count;
  const Clock::time_point now = Clock::now();
  const std::chrono::milliseconds interval(is_terminal_ ? 200 : 5000);
  if (now - last_print_ < interval || now - start_ < std::chrono::seconds(1)) return;
  last_print_ = now;
  has_printed_ = true;
  Print(now);
}

void Progress::Print(Clock::time_point now) {
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double rate = static_cast<double>(done_) / elapsed;
  const double seconds_left = rate > 0.0 ? static_cast<double>(total_ - done_) / rate : 0.0;
  const std::string line = fmt::format(
      "{} / {} {} ({:.0f} %), {:.3g} per second, {} left", done_, total_, unit_,
      100.0 * static_cast<double>(done_) / static_cast<double>(total_), rate, DurationInWords(seconds_left));
  if (is_terminal_) {
    fmt::print(stderr, "\r{:<79}", line);
  } else {
    fmt::print(stderr, "{}\n", line);
  }
  std::fflush(stderr);
}

std::string DurationInWords(double seconds) {
  const auto whole = static_cast<long long>(std::ceil(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace rcme
