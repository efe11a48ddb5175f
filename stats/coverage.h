#pragma once

#include <array>
#include <cstdint>

#include "stats/intervals.h"

namespace rcme {

// The coverage of confidence regions at several levels: how often a statistic that should be chi-square
// distributed stays below the quantiles of that law. Counts a stream of trials in constant memory.
class Coverage {
 public:
  static constexpr std::array<double, 5> kSignificanceLevels = {0.5, 0.2, 0.1, 0.05, 0.01};  // alpha

  struct Level {
    double nominal = 0.0;  // 1 - alpha
    std::int64_t num_covered = 0, n = 0;
    double measured = 0.0;  // num_covered / n, NaN without trials
    Interval interval;      // exact, of the measured coverage
    bool IsNominal() const { return interval.Contains(nominal); }
  };

  explicit Coverage(int degrees_of_freedom);

  // A NaN, infinite or negative value counts as not covered at every level.
  void Add(double statistic);
  // Adds the other's statistics. Throws std::invalid_argument for different degrees of freedom.
  void Merge(const Coverage& other);

  std::int64_t n() const { return n_; }
  int degrees_of_freedom() const { return degrees_of_freedom_; }
  // One entry per significance level, in their order. `confidence` applies to each interval separately.
  std::array<Level, kSignificanceLevels.size()> Levels(double confidence = 0.95) const;

 private:
  int degrees_of_freedom_;
  std::array<double, kSignificanceLevels.size()> quantiles_{};
  std::array<std::int64_t, kSignificanceLevels.size()> num_covered_{};
  std::int64_t n_ = 0;
};

}  // namespace rcme
