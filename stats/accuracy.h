// Performance measures of an estimator from its errors (estimate minus truth) over independent trials, each
// with its Monte-Carlo standard error (Morris, White & Crowther 2019, table 6).
#pragma once

#include <cstdint>
#include <vector>

#include "stats/intervals.h"
#include "stats/moments.h"

namespace rcme {

struct Measured {
  double value = 0.0, standard_error = 0.0;
};

// A stream of errors in constant memory. NaN if there are not enough of them (one for a value, two for a
// standard error). A NaN or infinite error makes every measure NaN or infinite, on purpose: do not add
// refusals here, count them separately.
class Accuracy {
 public:
  void Add(double error) { errors_.Add(error), squares_.Add(error * error); }
  void Merge(const Accuracy& other) { errors_.Merge(other.errors_), squares_.Merge(other.squares_); }

  std::int64_t n() const { return errors_.n(); }
  // Mean error; s / sqrt(n).
  Measured bias() const;
  // Standard deviation s of the errors; s / sqrt(2 (n - 1)), which holds for normal errors.
  Measured empirical_standard_error() const;
  // Mean squared error; standard deviation of the squares / sqrt(n).
  Measured mean_squared_error() const;
  // The root of the mean squared error. It is not in the table; by the delta method its standard error is
  // that of the MSE / (2 RMSE). 0 of 0 is 0.
  Measured root_mean_squared_error() const;

 private:
  Moments errors_, squares_;
};

// The ranks, counted from 1, of two of n ascending values that enclose the p-quantile of their law with at
// least `confidence`. Each end is missed with at most half of the remaining probability, whatever the law.
// `lower` is 0 and `upper` n + 1 if no value is far enough out.
struct RankInterval {
  std::int64_t lower = 0, upper = 0;
};
RankInterval QuantileRanks(std::int64_t n, double p, double confidence = 0.95);

// The p-quantile of a law from n independent values: the ceil(n p)-th smallest (the left-continuous inverse
// of the empirical distribution function).
struct MeasuredQuantile {
  double value = 0.0;
  // Half the distance between the order statistics n p +- sqrt(n p (1 - p)), rounded outwards and kept to
  // 1..n. No density is estimated and no normality assumed.
  double standard_error = 0.0;
  // Between two order statistics and distribution-free: contains the quantile with at least `confidence`,
  // each end missed with at most half of the remaining probability. An end is infinite if no order statistic
  // is far enough out.
  Interval interval;
};
// Throws std::invalid_argument if there are no values, one is NaN, or p or confidence is not in (0, 1).
MeasuredQuantile MeasureQuantile(std::vector<double> values, double p, double confidence = 0.95);

}  // namespace rcme
