// Student's t as a mixture of normal laws of different scales.
#pragma once

#include <vector>

#include "stats/random.h"

namespace rcme {

// Student's t with m degrees of freedom is a normal number times sqrt(m / chi-square_m). Here this factor
// takes 32 values of equal probability, its quantiles at (k + 1/2) / 32, divided by their root mean square.
// The tails are as long as data of thousands can show, and the variance is 1 even if m <= 2. Values are
// rounded to six digits, so that all libraries agree.
class StudentScales {
 public:
  // 0 degrees of freedom: normal, every scale is 1.
  explicit StudentScales(double degrees_of_freedom);
  const std::vector<double>& scales() const { return scales_; }  // descending
  double Draw(RandomStream& rng) const;

 private:
  std::vector<double> scales_;
};

}  // namespace rcme
