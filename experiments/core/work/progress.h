#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace rcme {

// Progress on standard error: done / total, rate, time left. One line rewritten on a terminal; elsewhere a
// plain line every five seconds. Says nothing for work that ends within a second.
class Progress {
 public:
  // `num_done_before` of the total were done by an earlier run; the rate does not count them.
  Progress(std::string unit, std::int64_t total, std::int64_t num_done_before = 0);
  ~Progress();  // ends the line

  // Callable from several threads.
  void Advance(std::int64_t count);
  std::int64_t num_done() const { return done_; }

 private:
  using Clock = std::chrono::steady_clock;
  void Print(Clock::time_point now);

  std::string unit_;
  std::int64_t total_, num_done_before_;
  std::atomic<std::int64_t> done_;
  bool is_terminal_, has_printed_ = false;
  std::chrono::milliseconds interval_;
  Clock::time_point start_;
  std::atomic<Clock::time_point> next_print_;
  std::mutex print_mutex_;
};

// Seconds as "45 s", "3 min 20 s", "2 h 05 min".
std::string DescribeDuration(double seconds);

}  // namespace rcme
