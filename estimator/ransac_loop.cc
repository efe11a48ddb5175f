#include "estimator/ransac_loop.h"

#include <algorithm>
#include <cmath>

#include "stats/distributions.h"

namespace rcme {
namespace {

bool HasDuplicates(const Sample& sample) {
  bool any = false;
  for (size_t i = 1; i < sample.size(); ++i) {
    for (size_t k = 0; k < i; ++k) any |= sample[i] == sample[k];
  }
  return any;
}

// Moves the distinct indices to the front, in order; returns their end.
Sample::iterator KeepFirstOfEach(Sample* sample) {
  auto end = sample->begin();
  for (const int index : *sample) {
    if (std::find(sample->begin(), end, index) == end) *end++ = index;
  }
  return end;
}

}  // namespace

Thresholds Thresholds::For(const MotionProblem& problem, const RansacOptions& options, int point_dof) {
  const double confidence = 1.0 - options.significance_level;
  const double diagonal_px = std::hypot(problem.camera2.width, problem.camera2.height);
  const double sample_level = options.SampleLevelOrDefault();
  const double sample = ChiSquareQuantile(3, 1.0 - sample_level);
  const bool is_same = point_dof == 3 && sample_level == options.significance_level;
  return {is_same ? sample : ChiSquareQuantile(point_dof, confidence), sample, NormalQuantile(confidence),
          std::log(std::max(diagonal_px / problem.sigma_px, 1.0))};
}

// S_j (eq::minimal_sample_set)
Sample DrawSample(int n, RandomStream& rng) {
  Sample sample;
  for (auto end = sample.begin();;) {
    while (end != sample.end()) *end++ = static_cast<int>(rng.IntegerBelow(static_cast<std::uint32_t>(n)));
    if (!HasDuplicates(sample))
      return sample;  // what was drawn again is drawn anew, the others keep their places
    end = KeepFirstOfEach(&sample);
  }
}

}  // namespace rcme
