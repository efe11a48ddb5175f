// Counter-based random streams: Philox4x32-10 (Salmon et al. 2011, from Random123).
//
// A stream is named, never seeded by time, thread or order of creation. Different names give streams without
// a common block: the name fills the 64-bit key and three of the four counter words, and the fourth word
// counts blocks. A stream has 2^32 blocks of four words. The same name gives the same numbers on every
// machine.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "stats/random_kernels.h"

namespace rcme {

struct StreamName {
  std::uint64_t seed = 0;
  std::uint64_t condition = 0;  // a number or a hash of at most 48 bits
  std::uint32_t trial = 0;
  std::uint32_t purpose = 0;  // at most 16 bits
};

class RandomStream {
 public:
  // Throws std::out_of_range if a condition or purpose is too large.
  explicit RandomStream(const StreamName& name);

  std::uint32_t Next32() {
    if (num_used_ == 2 * kNumPairs) Refill();
    const std::uint64_t pair = pairs_[num_used_ / 2];
    return static_cast<std::uint32_t>(num_used_++ % 2 == 0 ? pair : pair >> 32);
  }
  std::uint64_t Next64() {  // two words, the first one low
    const std::uint64_t low = Next32();
    return low | (static_cast<std::uint64_t>(Next32()) << 32);
  }

  // Uniform on [0, 1): a multiple of 2^-53.
  double Uniform() { return static_cast<double>(Next64() >> 11) * 0x1p-53; }
  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }

  // Standard normal, Box-Muller; the second of each pair is kept for the next call.
  double Normal();

  // Bit-identical to as many calls of Uniform() or Normal(), but several times faster.
  void FillUniform(std::span<double> uniforms);
  void FillNormal(std::span<double> normals);

  // Uniform on {0, ..., n - 1} without bias (Lemire 2019), n >= 1.
  std::uint32_t IntegerBelow(std::uint32_t n) {
    std::uint64_t product = static_cast<std::uint64_t>(Next32()) * n;
    if (static_cast<std::uint32_t>(product) < n) {
      const std::uint32_t num_biased = (0U - n) % n;  // 2^32 mod n
      while (static_cast<std::uint32_t>(product) < num_biased) {
        product = static_cast<std::uint64_t>(Next32()) * n;
      }
    }
    return static_cast<std::uint32_t>(product >> 32);
  }

  // Fisher-Yates, every order equally likely.
  template <typename T>
  void Shuffle(std::span<T> items) {
    for (std::size_t i = items.size(); i > 1; --i) {
      std::swap(items[i - 1], items[IntegerBelow(static_cast<std::uint32_t>(i))]);
    }
  }

 private:
  static constexpr std::size_t kNumPairs = 4 * kBlocksAtOnce;

  void Refill();

  PhiloxInput next_;                            // input of the first block after the buffer
  std::array<std::uint64_t, kNumPairs> pairs_;  // pairs of words, the first one low; filled by the first draw
  std::size_t num_used_ = 2 * kNumPairs;        // words
  bool has_spare_normal_ = false;
  double spare_normal_ = 0.0;
};

// The bare generator, for known-answer tests: four words from a 128-bit counter and a 64-bit key.
std::array<std::uint32_t, 4> Philox4x32(const std::array<std::uint32_t, 4>& counter,
                                        const std::array<std::uint32_t, 2>& key);

}  // namespace rcme
