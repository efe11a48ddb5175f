#include "estimator/sample.h"

#include <algorithm>

#include "stats/random.h"

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
