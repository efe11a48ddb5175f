// Mean and variance of numbers without a rounding error in the sums: the same bits in whatever order, and in
// whatever groups, the numbers were added. Memory is constant.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rcme {

// A sum of doubles, exactly: a whole number of units of 2^-1074, the smallest double, in base 2^32 (the long
// accumulator of Kulisch).
class ExactSum {
 public:
  // Throws std::invalid_argument for what is not finite.
  void Add(double x);
  void Merge(const ExactSum& other);

  // The sum as a hexadecimal whole number and a power of two: "0", "-1a3p-20".
  std::string Text() const;
  // Throws std::invalid_argument for any other text.
  static ExactSum FromText(const std::string& text);

  // The digits, each in [0, 2^32) but the last, which has the sign; the unit is 2^-1074. Empty: 0.
  const std::vector<std::int64_t>& digits() const;

 private:
  void Carry() const;

  mutable std::vector<std::int64_t> digits_;
  mutable int num_added_ = 0;  // since the last carry: a digit holds 2^30 of them
};

// As Moments (stats/moments.h). The squares of numbers beyond 1e150 are infinite, as numbers that are.
class ExactMoments {
 public:
  // Throws std::invalid_argument for NaN.
  void Add(double x);
  void Merge(const ExactMoments& other);

  std::int64_t n() const { return n_; }
  double mean() const;      // NaN where there are not enough numbers, as the next two
  double variance() const;  // also NaN where a number is infinite
  double standard_error() const;

  // n, sum, sum of squares; the sum "inf", "-inf" or "nan" where it is not finite.
  std::vector<std::string> Texts() const;
  // Throws std::invalid_argument for texts that it does not give.
  static ExactMoments FromTexts(const std::vector<std::string>& texts);

 private:
  std::int64_t n_ = 0;
  ExactSum sum_, sum_squares_;
  bool has_plus_infinity_ = false, has_minus_infinity_ = false;
};

}  // namespace rcme
