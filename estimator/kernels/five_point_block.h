// The five-point problem for eight minimal samples side by side: all essential matrices through five matches.
#pragma once

#include "estimator/kernels/match_blocks.h"

namespace rcme {

// Eight samples of five matches, index [match within the sample][sample]. The rays are [x, y, 1] in the frame
// of their camera: pixels from the principal point divided by the focal length, no unit.
struct alignas(64) FivePointSamples {
  using Row = double[kBlockSize];
  Row x1[5], y1[5], x2[5], y2[5];
};

// The essential matrices of eight samples for rays: x2' E x1 = 0, X2 = R X1 + t, E = [t]x R up to its sign,
// Frobenius norm sqrt(2). Sample s has the models begin[s] ... begin[s + 1] - 1, in the order of their
// brackets (five_point_brackets-inl.h). They do not depend on the other samples of the block.
struct alignas(64) FivePointModels {
  static constexpr int kMaxPerSample = 10;
  static constexpr int kCapacity = kMaxPerSample * kBlockSize;

  double E[9][kCapacity];  // row by row, index [entry][model]
  int begin[kBlockSize + 1];

  int count() const { return begin[kBlockSize]; }
};

// Finds the real solutions of every sample. Only isolated solutions count, as for FivePoint::Solve, the
// scalar reference. There is no solution if
// - a number of the sample is not finite,
// - its five equations are dependent, as for a repeated match or points on one space line (a pivot of M'
//   below 1e-9 of its column),
// - the solutions form a family, as for a pure rotation or images that do not move (the three equations of
//   five_point_recovery-inl.h are dependent to 1e-9).
//
// Two solutions that nearly coincide may be missed. Allocates no memory, and gives the same bits on every
// instruction set.
void SolveFivePoints(const FivePointSamples& samples, FivePointModels* models);

}  // namespace rcme
