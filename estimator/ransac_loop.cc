#include "estimator/ransac_loop.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stats/distributions.h"

namespace rcme {
namespace {

bool HasDuplicates(const Sample& sample) {
  bool any = false;
  for (const int* i = sample.begin(); i != sample.end(); ++i) {
    for (const int* k = sample.begin(); k != i; ++k) any |= *i == *k;
  }
  return any;
}

// Moves the distinct indices to the front, in order; returns their end.
int* KeepFirstOfEach(Sample* sample) {
  int* end = sample->begin();
  for (const int index : *sample) {
    if (std::find(sample->begin(), end, index) == end) *end++ = index;
  }
  return end;
}

}  // namespace

Thresholds Thresholds::For(const MotionProblem& problem, const RansacOptions& options, int point_dof,
                           int sample_dof) {
  const double confidence = 1.0 - options.significance_level;
  const double diagonal_px = std::hypot(problem.camera2.width, problem.camera2.height);
  const double sample_level = options.SampleLevelOrDefault();
  const double sample = sample_dof == 0 ? std::numeric_limits<double>::infinity()
                                        : ChiSquareQuantile(sample_dof, 1.0 - sample_level);
  const bool is_same = point_dof == sample_dof && sample_level == options.significance_level;
  return {is_same ? sample : ChiSquareQuantile(point_dof, confidence), sample, NormalQuantile(confidence),
          std::log(std::max(diagonal_px / problem.sigma_px, 1.0))};
}

// S_j (eq::minimal_sample_set)
Sample DrawSample(int size, int n, RandomStream& rng) {
  Sample sample(size);
  for (int* end = sample.begin();;) {
    while (end != sample.end()) *end++ = static_cast<int>(rng.IntegerBelow(static_cast<std::uint32_t>(n)));
    if (!HasDuplicates(sample))
      return sample;  // what was drawn again is drawn anew, the others keep their places
    end = KeepFirstOfEach(&sample);
  }
}

}  // namespace rcme
