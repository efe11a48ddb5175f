// Points that fill the unit cube: designs of computer experiments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace rcme {

enum class PointSet {
  // Sobol's (1967) sequence with the direction numbers of Joe & Kuo (2008), by Boost.Random. Every coordinate
  // is combined (exclusive or) with random bits of its own, a digital shift (L'Ecuyer & Lemieux 2002). Any
  // 2^k points from
  // a multiple of 2^k on have one in each 2^-k of an axis, before and after the shift, and each point is
  // uniform. More points continue the sequence.
  kSobol,
  // McKay, Beckman & Conover (1979): n points have one in each n-th of each axis, at a random place in it.
  // The axes are paired at random. All points change with n.
  kLatinHypercube,
  kRandom  // independent and uniform; more points continue the sequence
};

// num_points points in [0, 1)^d. Each axis draws from random streams named (seed, key, ., purpose), with d
// keys of at most 48 bits. Coordinates on one axis therefore do not depend on other axes; for Sobol's
// sequence they also depend on the axis' index. Throws std::invalid_argument for more than kMaxAxes axes.
inline constexpr std::size_t kMaxAxes = 3667;
std::vector<std::vector<double>> DrawPoints(PointSet kind, std::size_t num_points,
                                            std::span<const std::uint64_t> keys_of_axes, std::uint64_t seed,
                                            std::uint32_t purpose);

}  // namespace rcme
