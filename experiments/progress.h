#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace rcme {

// Progress on standard error: done / total, rate, time left. One line rewritten on a terminal; elsewhere a
// plain line every five seconds. Says nothing for work that ends within a second.
class Progress {
 public:
  Progress(std::string unit, std::int64_t total);
  ~Progress();  // ends the line

  void Advance(std::int64_t count);

 private:
  using Clock = std::chrono::steady_clock;
  void Print(Clock::time_point now);

  std::string unit_;
  std::int64_t total_, done_ = 0;
  bool is_terminal_, has_printed_ = false;
  Clock::time_point start_, last_print_;
};

// Seconds as "45 s", "3 min 20 s", "2 h 05 min".
std::string DurationInWords(double seconds);

}  // namespace rcme
