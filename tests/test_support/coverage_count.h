#pragma once

#include <cstdint>
#include <ostream>

#include "stats/intervals.h"

namespace rcme {

// Counts how often something true happens and judges a nominal probability by the exact interval. A test that
// asserts Admits(nominal) at the default confidence raises a false alarm at a rate of at most 1e-4 over
// seeds.
class CoverageCount {
 public:
  void Add(bool hit) {
    ++n_;
    hits_ += hit ? 1 : 0;
  }
  std::int64_t n() const { return n_; }
  double rate() const { return static_cast<double>(hits_) / static_cast<double>(n_); }
  Interval interval(double confidence = 1.0 - 1e-4) const {
    return ExactBinomialInterval(hits_, n_, confidence);
  }
  bool Admits(double nominal) const { return interval().Contains(nominal); }

  friend std::ostream& operator<<(std::ostream& out, const CoverageCount& count) {
    const Interval exact = count.interval();
    return out << count.hits_ << " of " << count.n_ << " = " << count.rate() << " in [" << exact.lower << ", "
               << exact.upper << "] at confidence 0.9999";
  }

 private:
  std::int64_t hits_ = 0, n_ = 0;
};

}  // namespace rcme
