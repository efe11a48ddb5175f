// Points that fill the unit cube: the designs of computer experiments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace rcme {

enum class PointSet {
  // Sobol's (1967) sequence with the direction numbers of Joe & Kuo (2008), by Boost.Random. Every coordinate
  // is
  // combined (exclusive or) with random bits of its own: any stretch of 2^k points from a multiple of 2^k on
  // has
  // one in each 2^-k of an axis, before and after, and each point is uniform (Owen 1995 calls it a digital
  // shift). More points continue the sequence.
  kSobol,
  // McKay, Beckman & Conover (1979): n points have one in each n-th of each axis, at a random place in it;
  // the
  // axes are paired at random. All points change with n.
  kLatinHypercube,
  kRandom  // independent and uniform; more points continue the sequence
};

// num_points points in [0, 1)^d. Each axis draws from random streams named (seed, key, ., purpose), d keys of
// at most 48 bits: what a point has on it depends on no other axis but, of Sobol's sequence, on the axis'
// place. Throws std::invalid_argument beyond kMaxAxes.
inline constexpr std::size_t kMaxAxes = 3667;
std::vector<std::vector<double>> DrawPoints(PointSet kind, std::size_t num_points,
                                            std::span<const std::uint64_t> keys_of_axes, std::uint64_t seed,
                                            std::uint32_t purpose);

}  // namespace rcme
