#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace rcme {

// Mean and variance of a stream of numbers in constant memory (Welford 1962). Infinite numbers make the mean
// infinite (both infinities: NaN) and the variance NaN.
class Moments {
 public:
  Moments() = default;
  // The moments of `n` numbers with this mean and variance.
  static Moments FromStatistics(std::int64_t n, double mean, double variance) {
    Moments moments;
    moments.n_ = n;
    if (n > 0) moments.mean_ = mean;
    if (n > 1) moments.sum_squares_ = variance * static_cast<double>(n - 1);
    return moments;
  }

  void Add(double x) {
    ++n_;
    const double step = x - mean_;
    MoveMean(x, step / static_cast<double>(n_));
    sum_squares_ += step * (x - mean_);
  }

  // Adds the other's numbers (Chan, Golub & LeVeque 1983); equal up to rounding.
  void Merge(const Moments& other) {
    if (other.n_ == 0) return;
    const double n = static_cast<double>(n_), m = static_cast<double>(other.n_);
    const double step = other.mean_ - mean_;
    n_ += other.n_;
    MoveMean(other.mean_, step * m / (n + m));
    sum_squares_ += other.sum_squares_ + step * step * n * m / (n + m);
  }

  std::int64_t n() const { return n_; }
  // NaN if there are not enough numbers.
  double mean() const { return n_ > 0 ? mean_ : kNaN; }
  double variance() const { return n_ > 1 ? sum_squares_ / static_cast<double>(n_ - 1) : kNaN; }
  // Monte-Carlo standard error of the mean: s / sqrt(n).
  double standard_error() const { return std::sqrt(variance() / static_cast<double>(n_)); }

 private:
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

  // Moves the mean by a step towards `x`; the step is NaN or infinite if one of the two is infinite.
  void MoveMean(double x, double step) { mean_ += std::isinf(x) || std::isinf(mean_) ? x : step; }

  std::int64_t n_ = 0;
  double mean_ = 0.0, sum_squares_ = 0.0;
};

}  // namespace rcme
