#include "stats/random_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stats/random_kernels.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/highway.h>

#include "stats/portable_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

using Reals = hn::CappedTag<double, kBlocksAtOnce>;
using Pairs = hn::CappedTag<std::uint64_t, kBlocksAtOnce>;
using PairsVec = hn::Vec<Pairs>;

// The word in the lower half of each lane times a constant: the full 64-bit product.
HWY_INLINE PairsVec TimesWord(PairsVec x, std::uint32_t factor) {
#if HWY_TARGET == HWY_SCALAR  // has no vectors of two words
  return hn::Set(Pairs(), (hn::GetLane(x) & 0xffffffffu) * factor);
#else
  const hn::Repartition<std::uint32_t, Pairs> words;
  return hn::MulEven(hn::BitCast(words, x), hn::Set(words, factor));
#endif
}

// One block per lane. A word is in the lower half of its lane. The upper half is not cleared, as products do
// not read it.
struct PhiloxPairs {
  PairsVec first, second;

  HWY_INLINE PhiloxPairs(const PhiloxInput& input, std::size_t first_block) {
    const Pairs d;
    auto x0 = hn::Add(hn::Set(d, input.counter[0] + first_block), hn::Iota(d, 0));
    auto x1 = hn::Set(d, input.counter[1]);
    auto x2 = hn::Set(d, input.counter[2]);
    auto x3 = hn::Set(d, input.counter[3]);
    std::uint32_t key0 = input.key[0], key1 = input.key[1];
    for (int round = 0; round < 10; ++round) {
      const auto product0 = TimesWord(x0, 0xd2511f53u);
      const auto product2 = TimesWord(x2, 0xcd9e8d57u);
      x0 = hn::Xor(hn::Xor(hn::ShiftRight<32>(product2), x1), hn::Set(d, key0));
      x2 = hn::Xor(hn::Xor(hn::ShiftRight<32>(product0), x3), hn::Set(d, key1));
      x1 = product2;
      x3 = product0;
      key0 += 0x9e3779b9u;
      key1 += 0xbb67ae85u;
    }
    const auto low_half = hn::Set(d, 0xffffffffu);
    first = hn::Or(hn::And(x0, low_half), hn::ShiftLeft<32>(x1));
    second = hn::Or(hn::And(x2, low_half), hn::ShiftLeft<32>(x3));
  }
};

// Exact, since the integer is below 2^53.
HWY_INLINE hn::Vec<Reals> ConvertToUniform(PairsVec pair) {
  const hn::RebindToSigned<Pairs> di;
  const auto integer = hn::BitCast(di, hn::ShiftRight<11>(pair));
  return hn::Mul(hn::ConvertTo(Reals(), integer), hn::Set(Reals(), 0x1p-53));
}

void PhiloxWordPairs(PhiloxInput first, std::size_t num_pairs, std::uint64_t* HWY_RESTRICT pairs) {
  for (std::size_t block = 0; 2 * block < num_pairs; block += hn::Lanes(Pairs())) {
    const PhiloxPairs made(first, block);
    hn::StoreInterleaved2(made.first, made.second, Pairs(), pairs + 2 * block);
  }
}

void PhiloxUniforms(PhiloxInput first, std::size_t num_uniforms, double* HWY_RESTRICT uniforms) {
  for (std::size_t block = 0; 2 * block < num_uniforms; block += hn::Lanes(Pairs())) {
    const PhiloxPairs made(first, block);
    hn::StoreInterleaved2(ConvertToUniform(made.first), ConvertToUniform(made.second), Reals(),
                          uniforms + 2 * block);
  }
}

void NormalsFromUniforms(std::size_t num_values, double* HWY_RESTRICT values) {
  const Reals d;
  for (std::size_t i = 0; i < num_values; i += 2 * hn::Lanes(d)) {
    hn::Vec<Reals> u, v;
    hn::LoadInterleaved2(d, values + i, u, v);
    const auto log = ComputeLog(d, hn::Sub(hn::Set(d, 1.0), u));  // 1 - u is in (0, 1]
    const auto radius = hn::Sqrt(hn::Mul(hn::Set(d, -2.0), log));
    const CosSinOf turn(d, v);
    hn::StoreInterleaved2(hn::Mul(radius, turn.cos), hn::Mul(radius, turn.sin), d, values + i);
  }
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rcme {

HWY_EXPORT(PhiloxWordPairs);
HWY_EXPORT(PhiloxUniforms);
HWY_EXPORT(NormalsFromUniforms);

void PhiloxWordPairs(const PhiloxInput& first, std::size_t num_pairs, std::uint64_t* pairs) {
  HWY_DYNAMIC_DISPATCH(PhiloxWordPairs)(first, num_pairs, pairs);
}

void PhiloxUniforms(const PhiloxInput& first, std::size_t num_uniforms, double* uniforms) {
  HWY_DYNAMIC_DISPATCH(PhiloxUniforms)(first, num_uniforms, uniforms);
}

void NormalsFromUniforms(std::size_t num_values, double* values) {
  HWY_DYNAMIC_DISPATCH(NormalsFromUniforms)(num_values, values);
}

}  // namespace rcme
#endif  // HWY_ONCE
