#include "estimator/sample.h"

#include <algorithm>

#include "stats/random.h"

namespace rcme {
namespace {

template <size_t kSize>
bool HasDuplicates(const Sample& sample) {
  bool any = false;
  for (size_t i = 1; i < kSize; ++i) {
    for (size_t k = 0; k < i; ++k) any |= sample[i] == sample[k];
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

// With the size as a template argument the loops are unrolled, a quarter faster.
template <size_t kSize = kMaxSampleSize>
Sample DrawSampleOfSize(size_t size, int n, RandomStream& rng) {
  if constexpr (kSize > 1) {
    if (size < kSize) return DrawSampleOfSize<kSize - 1>(size, n, rng);
  }
  Sample sample(static_cast<int>(kSize));
  for (size_t num_drawn = 0;; num_drawn = static_cast<size_t>(KeepFirstOfEach(&sample) - sample.begin())) {
    for (size_t k = num_drawn; k < kSize; ++k)
      sample[k] = static_cast<int>(rng.IntegerBelow(static_cast<std::uint32_t>(n)));
    // Duplicates are drawn anew; the first of each keeps its place.
    if (!HasDuplicates<kSize>(sample)) return sample;
  }
}

}  // namespace

// S_j (eq::minimal_sample_set)
Sample DrawSample(int size, int n, RandomStream& rng) {
  return DrawSampleOfSize(static_cast<size_t>(size), n, rng);
}

}  // namespace rcme
