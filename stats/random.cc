#include "stats/random.h"

#include <Random123/philox.h>

#include <cmath>

#include "stats/portable_math.h"

namespace rcme {

std::array<std::uint32_t, 4> Philox4x32(const std::array<std::uint32_t, 4>& counter,
                                        const std::array<std::uint32_t, 2>& key) {
  const r123::Philox4x32 generator;
  r123::Philox4x32::ctr_type c;
  r123::Philox4x32::key_type k;
  for (size_t i = 0; i < 4; ++i) c[i] = counter[i];
  for (size_t i = 0; i < 2; ++i) k[i] = key[i];
  const r123::Philox4x32::ctr_type words = generator(c, k);
  return {words[0], words[1], words[2], words[3]};
}

RandomStream::RandomStream(const StreamName& name) : name_(name) {}

void RandomStream::Refill() {
  const std::array<std::uint32_t, 2> key = {static_cast<std::uint32_t>(name_.seed),
                                            static_cast<std::uint32_t>(name_.seed >> 32)};
  words_ = Philox4x32({next_block_++, name_.trial, name_.condition, name_.purpose}, key);
  num_used_ = 0;
}

std::uint32_t RandomStream::Next32() {
  if (num_used_ == 4) Refill();
  return words_[static_cast<size_t>(num_used_++)];
}

std::uint64_t RandomStream::Next64() {
  const std::uint64_t low = Next32();
  return low | (static_cast<std::uint64_t>(Next32()) << 32);
}

double RandomStream::Uniform() { return static_cast<double>(Next64() >> 11) * 0x1p-53; }

double RandomStream::Normal() {
  if (has_spare_normal_) {
    has_spare_normal_ = false;
    return spare_normal_;
  }
  const double radius = std::sqrt(-2.0 * PortableLog(1.0 - Uniform()));  // 1 - U is in (0, 1]
  const CosSin direction = PortableCosSinOfTurn(Uniform());
  spare_normal_ = radius * direction.sin;
  has_spare_normal_ = true;
  return radius * direction.cos;
}

std::uint32_t RandomStream::IntegerBelow(std::uint32_t n) {
  std::uint64_t product = static_cast<std::uint64_t>(Next32()) * n;
  if (static_cast<std::uint32_t>(product) < n) {
    const std::uint32_t num_biased = (0U - n) % n;  // 2^32 mod n
    while (static_cast<std::uint32_t>(product) < num_biased) {
      product = static_cast<std::uint64_t>(Next32()) * n;
    }
  }
  return static_cast<std::uint32_t>(product >> 32);
}

}  // namespace rcme
