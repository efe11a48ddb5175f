#include "tests/benchmarks/rounds.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace rcme {
namespace {

double Now(Task::Clock clock) {
  timespec now{};
  clock_gettime(clock == Task::Clock::kWall ? CLOCK_MONOTONIC : CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double MeasureSeconds(const Task& task, int num_runs) {
  const double start = Now(task.clock);
  for (int i = 0; i < num_runs; ++i) task.run();
  return Now(task.clock) - start;
}

struct Repetition {
  int num_runs;
  bool warms_up;
};

// The second of two runs counts: the first one fills caches.
Repetition ChooseRepetition(const Task& task, double least_seconds) {
  task.run();
  const double seconds = std::max(MeasureSeconds(task, 1), 1e-9);
  return {std::max(1, static_cast<int>(std::ceil(least_seconds / seconds))), seconds < 10.0 * least_seconds};
}

}  // namespace

std::map<std::string, PerRound> MeasureRounds(const std::vector<Task>& tasks, int num_rounds,
                                              double least_seconds) {
  std::vector<Repetition> repetitions;
  for (const Task& task : tasks) repetitions.push_back(ChooseRepetition(task, least_seconds));
  std::vector<size_t> order(tasks.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::mt19937 rng(1);
  std::map<std::string, PerRound> seconds;
  for (int round = 0; round < num_rounds; ++round) {
    std::shuffle(order.begin(), order.end(), rng);
    for (const size_t i : order) {
      const Task& task = tasks[i];
      const auto [num_runs, warms_up] = repetitions[i];
      if (warms_up) task.run();
      seconds[task.name].push_back(MeasureSeconds(task, num_runs) / (num_runs * task.num_calls));
    }
  }
  return seconds;
}

PerRound Quotient(const PerRound& numerator, const PerRound& denominator) {
  PerRound quotient;
  for (size_t round = 0; round < numerator.size(); ++round)
    quotient.push_back(numerator[round] / denominator[round]);
  return quotient;
}

PerRound Exponent(const std::vector<int>& sizes, const std::vector<PerRound>& seconds) {
  std::vector<double> x;
  for (const int size : sizes) x.push_back(std::log(size));
  const double mean = std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
  double spread = 0.0;
  for (double& value : x) value -= mean, spread += value * value;
  PerRound slopes(seconds[0].size(), 0.0);
  for (size_t round = 0; round < slopes.size(); ++round) {
    for (size_t i = 0; i < x.size(); ++i) slopes[round] += x[i] / spread * std::log(seconds[i][round]);
  }
  return slopes;
}

MeasuredQuantile MeasureMedian(const PerRound& values) { return MeasureQuantile(values, 0.5); }

}  // namespace rcme
