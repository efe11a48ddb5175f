// Student's t as a mixture of normal laws: some of its draws are precise, some are not.
#pragma once

#include <vector>

#include "stats/random.h"

namespace rcme {

// Student's t with m degrees of freedom is a normal number times the root of m / chi-square_m. Here that root
// takes 32 values of equal probability, its quantiles at (k + 1/2) / 32, over their root mean square: tails
// as long as any data of thousands show, and a variance (1) even where m <= 2. Rounded to six digits, so that
// libraries agree.
class StudentScales {
 public:
  // 0 degrees of freedom: normal, every scale is 1.
  explicit StudentScales(double degrees_of_freedom);
  const std::vector<double>& scales() const { return scales_; }  // falling
  double Draw(RandomStream& rng) const;

 private:
  std::vector<double> scales_;
};

}  // namespace rcme
