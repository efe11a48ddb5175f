// Confidence sequence of the mean of a bounded quantity: intervals that hold at all sample sizes at once,
// whatever the law of the numbers, and are narrower the less the numbers scatter.
//
// A gambler who stakes a share lambda in [0, 1] of his capital on "the mean exceeds m" has, after numbers
// x_1..x_n in [0, 1],
//   K_n(m) = mean over the stakes lambda of prod_i (1 + lambda (x_i - m)),
// a non-negative martingale of mean 1 if m is the mean. By Ville's inequality P(K_n(m) >= 1 / a for any n)
// <= a, and K_n falls with m: every m with K_n(m) >= 1 / a lies below the mean with confidence 1 - a for all
// n together (betting, Waudby-Smith & Ramdas 2024). The mirror image bounds the mean from above.
#pragma once

#include <array>
#include <cstdint>

#include "stats/intervals.h"

namespace rcme {

// Numbers in [0, 1], counted in bins; each counts as the middle of its bin. That moves a mean by at most half
// a bin, 1 / 256, and by far less where the law has a density: uniform numbers keep their mean exactly.
class BoundedMean {
 public:
  static constexpr int kNumBins = 128;

  // Throws std::invalid_argument outside [0, 1] and for NaN.
  void Add(double x);
  // `count` numbers in a bin; not necessarily a whole number, as for the numbers expected under a law.
  void AddToBin(int bin, double count);
  static double MiddleOf(int bin) { return (bin + 0.5) / kNumBins; }

  std::int64_t n() const { return static_cast<std::int64_t>(n_ + 0.5); }
  // NaN without numbers.
  double mean() const;
  double standard_deviation() const;

  // Two-sided: either bound has half of 1 - confidence. [0, 1] without numbers.
  Interval Sequence(double confidence = 0.95) const;

 private:
  double n_ = 0.0;
  std::array<double, kNumBins> counts_{};
};

}  // namespace rcme
