// The arithmetic of stats/random.h on whole vectors, for the instruction set found at run time. Results are
// bit-identical for all instruction sets.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace rcme {

// The 128-bit counter and the 64-bit key of a Philox4x32-10 block; blocks of a stream differ in counter[0].
struct PhiloxInput {
  std::array<std::uint32_t, 4> counter;
  std::array<std::uint32_t, 2> key;
};

// The counts passed to the functions below must be multiples of these.
inline constexpr std::size_t kBlocksAtOnce = 8;
inline constexpr std::size_t kUniformsAtOnce = 2 * kBlocksAtOnce;

// The words of the blocks counter[0], counter[0] + 1, ...: two pairs per block, the first word of a pair low.
void PhiloxWordPairs(const PhiloxInput& first, std::size_t num_pairs, std::uint64_t* pairs);

// The same pairs as uniforms: the upper 53 bits of a pair times 2^-53.
void PhiloxUniforms(const PhiloxInput& first, std::size_t num_uniforms, double* uniforms);

// Box-Muller in place: uniforms (u, v) become sqrt(-2 log(1 - u)) (cos 2 pi v, sin 2 pi v).
void NormalsFromUniforms(std::size_t num_values, double* values);

}  // namespace rcme
