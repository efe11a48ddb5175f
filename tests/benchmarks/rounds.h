// Times of several tasks that can be compared although the machine is shared: every round measures each task
// once, in an order of its own, and what is compared is compared within a round. Whatever lasts longer than a
// round (another load, another clock frequency) drops out of the ratios; what is shorter is outvoted by the
// median.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "stats/measured_quantile.h"

namespace rcme {

struct Task {
  enum class Clock { kThreadCpu, kWall };
  std::string name;
  std::function<void()> run;
  double num_calls = 1.0;  // of one run
  Clock clock = Clock::kThreadCpu;
};

// One number per round.
using PerRound = std::vector<double>;

// Seconds per call of every task by its name. A run is repeated until it takes `least_seconds`, the same
// number of times in every round, and is preceded by one that is not timed: it fills the caches. That one is
// left out for the wall clock, whose tasks are long.
std::map<std::string, PerRound> MeasureRounds(const std::vector<Task>& tasks, int num_rounds,
                                              double least_seconds);

PerRound Quotient(const PerRound& numerator, const PerRound& denominator);

// The slope of log(seconds) over log(size) by least squares, round by round.
PerRound Exponent(const std::vector<int>& sizes, const std::vector<PerRound>& seconds);

// Median over rounds with its distribution-free interval, confidence 95 % (from six rounds on).
MeasuredQuantile MeasureMedian(const PerRound& values);

}  // namespace rcme
