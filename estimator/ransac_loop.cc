#include "estimator/ransac_loop.h"

#include <algorithm>
#include <cmath>

#include "stats/distributions.h"

namespace rcme {

Thresholds Thresholds::For(const MotionProblem& problem, const RansacOptions& options, int point_dof) {
  const double confidence = 1.0 - options.significance_level;
  const double diagonal_px = std::hypot(problem.camera2.width, problem.camera2.height);
  return {ChiSquareQuantile(point_dof, confidence), ChiSquareQuantile(3, confidence),
          NormalQuantile(confidence), std::log(std::max(diagonal_px / problem.sigma_px, 1.0))};
}

Sample DrawSample(int n, RandomStream& rng) {
  Sample sample{};
  auto end = sample.begin();
  while (end != sample.end()) {
    const int index = static_cast<int>(rng.IntegerBelow(static_cast<std::uint32_t>(n)));
    if (std::find(sample.begin(), end, index) == end) *end++ = index;
  }
  return sample;
}

}  // namespace rcme
