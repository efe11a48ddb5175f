// Every instruction set of this machine must give the bits of a plain twin: Random123's Philox, and the
// scalar calls of RandomStream.
#include "stats/random_kernels.h"

#include <Random123/philox.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <vector>

#include "stats/portable_math.h"
#include "stats/random.h"
#include "tests/test_support/every_target.h"

namespace rcme {
namespace {

std::vector<std::uint64_t> ListBits(const std::vector<double>& values) {
  std::vector<std::uint64_t> bits;
  for (const double value : values) bits.push_back(std::bit_cast<std::uint64_t>(value));
  return bits;
}

// The counter's first word passes from 2^32 - 1 to 0 within a vector and carries into no other word.
constexpr PhiloxInput kBeforeWrap = {{0xfffffff9u, 0xffffffffu, 12u, 0x80000000u},
                                     {0xdeadbeefu, 0xffffffffu}};

std::vector<std::uint64_t> PairsOfRandom123(const PhiloxInput& first, size_t num_pairs) {
  std::vector<std::uint64_t> pairs;
  r123::Philox4x32::ctr_type counter = {
      {first.counter[0], first.counter[1], first.counter[2], first.counter[3]}};
  const r123::Philox4x32::key_type key = {{first.key[0], first.key[1]}};
  for (; pairs.size() < num_pairs; ++counter[0]) {
    const r123::Philox4x32::ctr_type words = r123::Philox4x32()(counter, key);
    for (size_t i = 0; i < 4; i += 2) pairs.push_back(words[i] | std::uint64_t{words[i + 1]} << 32);
  }
  return pairs;
}

TEST_F(OnEveryTarget, WordsAreThoseOfRandom123) {
  const std::vector<std::uint64_t> expected = PairsOfRandom123(kBeforeWrap, 64);
  Run([&] {
    std::vector<std::uint64_t> pairs(64);
    PhiloxWordPairs(kBeforeWrap, pairs.size(), pairs.data());
    EXPECT_EQ(pairs, expected);
  });
}

TEST_F(OnEveryTarget, UniformsAreTheUpper53BitsOfTheWords) {
  std::vector<double> expected;
  for (const std::uint64_t pair : PairsOfRandom123(kBeforeWrap, 64)) {
    expected.push_back(std::ldexp(static_cast<double>(pair >> 11), -53));
  }
  Run([&] {
    std::vector<double> uniforms(64);
    PhiloxUniforms(kBeforeWrap, uniforms.size(), uniforms.data());
    EXPECT_EQ(ListBits(uniforms), ListBits(expected));
  });
}

// At the ends of [0, 1), at and around the eighths of a turn, and in between, in all pairs.
TEST_F(OnEveryTarget, NormalsAreThoseOfTheScalarFunctions) {
  std::vector<double> corners = {0x1p-53, 0x1p-30, 1.0 - 0x1p-53, 0.3, 1.0 - std::sqrt(0.5)};
  for (int eighth = 0; eighth < 8; ++eighth) {
    const double u = eighth / 8.0;
    for (const double near : {u, u + 0x1p-53, std::abs(u - 0x1p-53)}) corners.push_back(near);
  }
  for (int k = 1; k < 37; ++k) corners.push_back(k / 37.0);
  std::vector<double> uniforms, expected;
  for (const double u : corners) {
    for (const double v : corners) {
      uniforms.insert(uniforms.end(), {u, v});
      const double radius = std::sqrt(-2.0 * PortableLog(1.0 - u));
      const CosSin turn = PortableCosSinOfTurn(v);
      expected.insert(expected.end(), {radius * turn.cos, radius * turn.sin});
    }
  }
  const size_t size = uniforms.size() / kUniformsAtOnce * kUniformsAtOnce;
  ASSERT_GT(size, 8000u);
  expected.resize(size);
  Run([&] {
    std::vector<double> values(uniforms.begin(), uniforms.begin() + static_cast<std::ptrdiff_t>(size));
    NormalsFromUniforms(size, values.data());
    EXPECT_EQ(ListBits(values), ListBits(expected));
  });
}

// The stream after a few words and perhaps one normal, which leaves a spare.
RandomStream Begun(int num_words, bool has_spare) {
  RandomStream rng({.seed = 1, .condition = 2, .trial = 3, .purpose = 4});
  for (int i = 0; i < num_words; ++i) rng.Next32();
  if (has_spare) rng.Normal();
  return rng;
}

constexpr size_t kLengths[] = {0, 1, 2, 3, 15, 16, 17, 31, 32, 33, 47, 48, 63, 64, 65, 100, 1000};
constexpr int kStarts[] = {0, 1, 2, 3, 4, 31, 32, 33, 62, 63, 64, 65, 127, 128, 1001};

TEST_F(OnEveryTarget, FillUniformIsAsManyCallsOfUniform) {
  Run([] {
    for (const int start : kStarts) {
      RandomStream filled = Begun(start, false), called = Begun(start, false);
      for (const size_t length : kLengths) {
        std::vector<double> uniforms(length), expected(length);
        filled.FillUniform(uniforms);
        for (double& u : expected) u = called.Uniform();
        ASSERT_EQ(ListBits(uniforms), ListBits(expected)) << length << " from word " << start;
        ASSERT_EQ(filled.Next64(), called.Next64()) << "after " << length << " from word " << start;
      }
    }
  });
}

TEST_F(OnEveryTarget, FillNormalIsAsManyCallsOfNormal) {
  Run([] {
    for (const int start : kStarts) {
      for (const bool has_spare : {false, true}) {
        RandomStream filled = Begun(start, has_spare), called = Begun(start, has_spare);
        for (const size_t length : kLengths) {  // odd lengths leave a spare for the next one
          std::vector<double> normals(length), expected(length);
          filled.FillNormal(normals);
          for (double& z : expected) z = called.Normal();
          ASSERT_EQ(ListBits(normals), ListBits(expected)) << length << " from word " << start;
          ASSERT_EQ(filled.Next32(), called.Next32()) << "after " << length << " from word " << start;
        }
      }
    }
  });
}

}  // namespace
}  // namespace rcme
