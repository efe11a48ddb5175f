// Mean and variance of numbers without rounding error in the sums: bit-identical for any order and grouping
// of the numbers. Constant memory.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rcme {

// An exact sum of doubles: an integer multiple of 2^-1074, the smallest double, in base 2^32 (the long
// accumulator of Kulisch).
class ExactSum {
 public:
  // Throws std::invalid_argument for a number that is not finite.
  void Add(double x);
  void Merge(const ExactSum& other);

  // The sum as a hexadecimal integer and a power of two: "0", "-1a3p-20".
  std::string Text() const;
  // Throws std::invalid_argument for any other text.
  static ExactSum FromText(const std::string& text);

  // The digits, each in [0, 2^32) except the last, which carries the sign; the unit is 2^-1074. Empty: 0.
  const std::vector<std::int64_t>& digits() const;

 private:
  void Carry() const;

  mutable std::vector<std::int64_t> digits_;
  mutable int num_added_ = 0;  // since the last carry: a digit holds 2^30 of them
};

// Like Moments (stats/moments.h). Numbers beyond 1e150 count as infinite, so that no square is.
class ExactMoments {
 public:
  // Throws std::invalid_argument for NaN.
  void Add(double x);
  void Merge(const ExactMoments& other);

  std::int64_t n() const { return n_; }
  double mean() const;      // these three are NaN if there are not enough numbers
  double variance() const;  // also NaN if a number is infinite
  double standard_error() const;

  // n, sum, sum of squares; a sum that is not finite is "inf", "-inf" or "nan".
  std::vector<std::string> Texts() const;
  // Throws std::invalid_argument for texts that Texts() cannot have written.
  static ExactMoments FromTexts(const std::vector<std::string>& texts);

 private:
  std::int64_t n_ = 0;
  ExactSum sum_, sum_squares_;
  bool has_plus_infinity_ = false, has_minus_infinity_ = false;
};

}  // namespace rcme
