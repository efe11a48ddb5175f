// The known answers of the stream come from tests/known_answers/philox_stream.py (plain Python integers and
// math.log / math.cos):  python3 tests/known_answers/philox_stream.py
//
// Every statistical test here is decided at a false-alarm rate of 1e-4 over seeds (the seed is 1), and is
// shown to reject a generator that is wrong on purpose.
#include "stats/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <vector>

#include "stats/distributions.h"
#include "tests/test_support/goodness_of_fit.h"

namespace rcme {
namespace {

constexpr double kFalseAlarmRate = 1e-4;

RandomStream KnownStream() {
  return RandomStream({.seed = 0x0123456789abcdefULL, .condition = 7, .trial = 11, .purpose = 3});
}

// Pearson's statistic of equally likely cells.
double ChiSquareOfEqualCells(const std::vector<int>& counts) {
  const double expected = static_cast<double>(std::accumulate(counts.begin(), counts.end(), 0)) /
                          static_cast<double>(counts.size());
  double statistic = 0.0;
  for (const int count : counts) statistic += (count - expected) * (count - expected) / expected;
  return statistic;
}

bool CellsAreEqual(const std::vector<int>& counts) {
  return ChiSquareOfEqualCells(counts) <=
         ChiSquareQuantile(static_cast<int>(counts.size()) - 1, 1.0 - kFalseAlarmRate);
}

TEST(Philox, KnownAnswersOfRandom123) {
  // Random123, tests/kat_vectors, philox4x32 10.
  using Words = std::array<std::uint32_t, 4>;
  constexpr std::uint32_t kOnes = 0xffffffffu;
  EXPECT_EQ(Philox4x32({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5u, 0xe169c58du, 0xbc57ac4cu, 0x9b00dbd8u}));
  EXPECT_EQ(Philox4x32({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (Words{0x408f276du, 0x41c83b0eu, 0xa20bc7c6u, 0x6d5451fdu}));
  EXPECT_EQ(Philox4x32({0x243f6a88u, 0x85a308d3u, 0x13198a2eu, 0x03707344u}, {0xa4093822u, 0x299f31d0u}),
            (Words{0xd16cfe09u, 0x94fdccebu, 0x5001e420u, 0x24126ea1u}));
}

TEST(RandomStream, WordsAreTheKnownOnes) {
  RandomStream rng = KnownStream();
  for (const std::uint32_t word : {0x8cb0dfeau, 0x1aaef39fu, 0x34d03ec5u, 0x761bbc05u, 0x054854beu,
                                   0x51949cdfu, 0x1cbf9dcbu, 0xb2637762u, 0x8fb045beu, 0xa4fba1f7u}) {
    EXPECT_EQ(rng.Next32(), word);
  }
  RandomStream far = KnownStream();
  std::uint32_t last = 0;
  for (int i = 0; i < 100'000; ++i) last = far.Next32();
  EXPECT_EQ(last, 0xf67065d7u);
  RandomStream pairs = KnownStream();
  EXPECT_EQ(pairs.Next64(), 0x1aaef39f8cb0dfeaULL);
}

TEST(RandomStream, UniformsAreTheKnownOnesToTheBit) {
  RandomStream rng = KnownStream();
  for (const double u : {0x1.aaef39f8cb0d8p-4, 0x1.d86ef014d340ep-2, 0x1.4652737c15214p-2,
                         0x1.64c6eec4397f3p-1, 0x1.49f743ef1f608p-1, 0x1.49d5aff59a02fp-1}) {
    EXPECT_EQ(rng.Uniform(), u);
  }
  RandomStream scaled = KnownStream();
  EXPECT_EQ(scaled.Uniform(2.0, 6.0), 2.0 + 4.0 * 0x1.aaef39f8cb0d8p-4);
}

TEST(RandomStream, NormalsAreTheKnownOnes) {
  RandomStream rng = KnownStream();
  for (const double z : {-0.4554392969795586, 0.11279545846256232, -0.2872466312934499, -0.8275976325982954,
                         -0.8870900398565388, -1.1319594652430862, -1.2239624648661114, -1.451372110626751}) {
    EXPECT_NEAR(rng.Normal(), z, 1e-14);
  }
}

TEST(RandomStream, IntegersAreTheKnownOnes) {
  RandomStream rng = KnownStream();
  EXPECT_EQ(rng.IntegerBelow(1), 0u);
  EXPECT_EQ(rng.IntegerBelow(2), 0u);
  EXPECT_EQ(rng.IntegerBelow(6), 1u);
  EXPECT_EQ(rng.IntegerBelow(1000), 461u);
  for (const std::uint32_t integer : {66469774u, 1026520487u, 361739864u, 2244647305u, 1808020558u,
                                      2075965817u, 2579569292u, 2075140603u}) {
    EXPECT_EQ(rng.IntegerBelow(3u << 30), integer);  // a quarter of the words is refused
  }
  EXPECT_EQ(rng.IntegerBelow(0xffffffffu), 2718900680u);
}

TEST(RandomStream, ShuffleIsTheKnownOne) {
  std::vector<int> items(10);
  std::iota(items.begin(), items.end(), 0);
  RandomStream rng = KnownStream();
  rng.Shuffle(std::span(items));
  EXPECT_EQ(items, (std::vector<int>{6, 4, 2, 9, 7, 8, 3, 1, 0, 5}));
}

TEST(RandomStream, EveryPartOfTheNameMatters) {
  const StreamName name{.seed = 1, .condition = 2, .trial = 3, .purpose = 4};
  std::vector<StreamName> names(7, name);
  names[1].seed = 2;
  names[2].seed = 1 + (1ULL << 32);  // the high half too
  names[3].condition = 3;
  names[4].trial = 4;
  names[5].purpose = 5;
  names[6].condition = 2 + (1ULL << 32);  // its high part too
  std::map<std::uint32_t, int> seen;
  constexpr int kWords = 1000;
  for (const StreamName& each : names) {
    RandomStream rng(each);
    for (int i = 0; i < kWords; ++i) ++seen[rng.Next32()];
  }
  // 7000 words of 2^32 possible: 0.006 repetitions expected; two equal streams would give 1000.
  EXPECT_GE(seen.size(), 7u * kWords - 3u);
}

TEST(RandomStream, ANameThatIsTooLargeIsRefused) {
  EXPECT_NO_THROW(RandomStream({.condition = (1ULL << 48) - 1, .purpose = 65535}));
  EXPECT_THROW(RandomStream({.condition = 1ULL << 48}), std::out_of_range);
  EXPECT_THROW(RandomStream({.purpose = 65536}), std::out_of_range);
}

TEST(RandomStream, SameNameGivesTheSameNumbersWhateverElseIsDrawn) {
  RandomStream a({.seed = 1, .trial = 5}), other({.seed = 1, .trial = 6}), b({.seed = 1, .trial = 5});
  for (int i = 0; i < 100; ++i) {
    const double from_a = a.Normal();
    other.Next32();
    EXPECT_EQ(from_a, b.Normal());
  }
}

TEST(RandomStream, IntegerBelowSixIsUniform) {
  // 600 000 throws. Catches a cell that is wrong by 3 % with power above 0.99 (noncentrality 90 at a limit of
  // 25.7). It can not see the bias of Next32() % 6, which is 1e-9: the next test does, where it is large.
  RandomStream rng({.seed = 1, .purpose = 10});
  std::vector<int> counts(6), wrong(6);
  for (int i = 0; i < 600'000; ++i) {
    ++counts[rng.IntegerBelow(6)];
    // Wrong on purpose: a face 3 % too frequent.
    ++wrong[rng.Uniform() < 0.005 ? 0 : rng.IntegerBelow(6)];
  }
  EXPECT_TRUE(CellsAreEqual(counts)) << ChiSquareOfEqualCells(counts);
  EXPECT_FALSE(CellsAreEqual(wrong)) << "this test has no power: " << ChiSquareOfEqualCells(wrong);
}

TEST(RandomStream, IntegerBelowALargeBoundIsUnbiased) {
  // n = 3 * 2^30. Without rejection, word % n gives the lowest third twice as often as the others, and word *
  // n
  // >> 32 gives the multiples of 3 twice as often. Nine cells (third, remainder by 3), 9000 draws: the
  // noncentrality of either fault is 9000 / 8 = 1125 at a limit of 31.8, power 1 to within 1e-100.
  constexpr std::uint32_t kBound = 3u << 30;
  const auto cell = [](std::uint32_t i) { return 3 * (i >> 30) + i % 3; };
  RandomStream rng({.seed = 1, .purpose = 11});
  std::vector<int> counts(9), modulo(9), no_rejection(9);
  for (int i = 0; i < 9000; ++i) {
    const std::uint32_t drawn = rng.IntegerBelow(kBound);
    ASSERT_LT(drawn, kBound);
    ++counts[cell(drawn)];
    ++modulo[cell(rng.Next32() % kBound)];
    ++no_rejection[cell(
        static_cast<std::uint32_t>((static_cast<std::uint64_t>(rng.Next32()) * kBound) >> 32))];
  }
  EXPECT_TRUE(CellsAreEqual(counts)) << ChiSquareOfEqualCells(counts);
  EXPECT_FALSE(CellsAreEqual(modulo)) << "no power: " << ChiSquareOfEqualCells(modulo);
  EXPECT_FALSE(CellsAreEqual(no_rejection)) << "no power: " << ChiSquareOfEqualCells(no_rejection);
}

TEST(RandomStream, ShuffleGivesEveryOrderEquallyOften) {
  // 48 000 shuffles of four items over 24 orders, limit 58.6 (23 dof). The well-known wrong shuffle, which
  // swaps every item with any other, has orders with 8/256 to 15/256 instead of 1/24: noncentrality above
  // 1000.
  std::map<std::vector<int>, int> index;
  std::vector<int> order = {0, 1, 2, 3};
  do {
    const int next = static_cast<int>(index.size());
    index[order] = next;
  } while (std::next_permutation(order.begin(), order.end()));
  ASSERT_EQ(index.size(), 24u);

  RandomStream rng({.seed = 1, .purpose = 12});
  std::vector<int> counts(24), wrong(24);
  for (int i = 0; i < 48'000; ++i) {
    std::vector<int> items = {0, 1, 2, 3};
    rng.Shuffle(std::span(items));
    ++counts[static_cast<size_t>(index.at(items))];
    std::vector<int> naive = {0, 1, 2, 3};
    for (size_t k = 0; k < 4; ++k) std::swap(naive[k], naive[rng.IntegerBelow(4)]);
    ++wrong[static_cast<size_t>(index.at(naive))];
  }
  EXPECT_TRUE(CellsAreEqual(counts)) << ChiSquareOfEqualCells(counts);
  EXPECT_FALSE(CellsAreEqual(wrong)) << "no power: " << ChiSquareOfEqualCells(wrong);
}

TEST(RandomStream, UniformIsUniform) {
  // Kolmogorov-Smirnov over 200 000 draws: the limit is 2.23 / sqrt(n) = 0.0050. Catches a shift of one in a
  // hundred (Uniform() mapped to [0, 0.99]: distance 0.01, power above 0.9999).
  RandomStream rng({.seed = 1, .purpose = 13});
  std::vector<double> sample(200'000), wrong(sample.size());
  for (size_t i = 0; i < sample.size(); ++i) {
    sample[i] = rng.Uniform();
    ASSERT_GE(sample[i], 0.0);
    ASSERT_LT(sample[i], 1.0);
    wrong[i] = 0.99 * rng.Uniform();
  }
  const auto cdf = [](double x) { return std::clamp(x, 0.0, 1.0); };
  EXPECT_GT(TestKolmogorovSmirnov(sample, cdf).p_value, kFalseAlarmRate);
  EXPECT_LT(TestKolmogorovSmirnov(wrong, cdf).p_value, kFalseAlarmRate) << "no power";
}

TEST(RandomStream, NormalIsNormal) {
  // Kolmogorov-Smirnov over 4 million draws: the limit is 2.23 / sqrt(n) = 0.00111. The sum of twelve
  // uniforms minus six is 0.0023 away from the normal law (kurtosis 2.9) and a sigma off by 2 % is 0.0048
  // away; both are more than 5 standard errors beyond the limit, power above 0.999999.
  constexpr size_t kDraws = 4'000'000;
  RandomStream rng({.seed = 1, .purpose = 14});
  std::vector<double> sample(kDraws);
  for (double& z : sample) z = rng.Normal();
  EXPECT_GT(TestKolmogorovSmirnov(sample, NormalCdf).p_value, kFalseAlarmRate);
  for (double& z : sample) z *= 1.02;
  EXPECT_LT(TestKolmogorovSmirnov(sample, NormalCdf).p_value, kFalseAlarmRate)
      << "no power: sigma off by 2 %";
  for (double& z : sample) {
    z = -6.0;
    for (int k = 0; k < 12; ++k) z += rng.Uniform();
  }
  EXPECT_LT(TestKolmogorovSmirnov(sample, NormalCdf).p_value, kFalseAlarmRate) << "no power: twelve uniforms";
}

// sqrt(n) times the correlation of two sequences: N(0, 1) if they are independent.
double NormalizedCorrelation(const std::vector<double>& a, const std::vector<double>& b) {
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (size_t i = 0; i < a.size(); ++i) ab += a[i] * b[i], aa += a[i] * a[i], bb += b[i] * b[i];
  return std::sqrt(static_cast<double>(a.size())) * ab / std::sqrt(aa * bb);
}

TEST(RandomStream, NeighbouringNamesAreUncorrelated) {
  // 5 pairs of streams and the two members of each Box-Muller pair, 100 000 normals each; the limit shares
  // the false-alarm rate among them. A correlation of 0.03 (9.5 standard errors) is caught with power above
  // 0.999999.
  constexpr size_t kDraws = 100'000;
  const double limit = NormalQuantile(1.0 - 0.5 * kFalseAlarmRate / 6.0);
  const auto draw = [](const StreamName& name) {
    RandomStream rng(name);
    std::vector<double> normals(kDraws);
    for (double& z : normals) z = rng.Normal();
    return normals;
  };
  const StreamName name{.seed = 1, .condition = 20, .trial = 30, .purpose = 40};
  std::vector<StreamName> neighbours(5, name);
  neighbours[0].seed += 1;
  neighbours[1].seed += 1ULL << 32;
  neighbours[2].condition += 1;
  neighbours[3].trial += 1;
  neighbours[4].purpose += 1;
  const std::vector<double> base = draw(name);
  for (const StreamName& neighbour : neighbours) {
    EXPECT_LT(std::abs(NormalizedCorrelation(base, draw(neighbour))), limit);
  }
  std::vector<double> first, second;
  for (size_t i = 0; i + 1 < kDraws; i += 2) first.push_back(base[i]), second.push_back(base[i + 1]);
  EXPECT_LT(std::abs(NormalizedCorrelation(first, second)), limit);

  std::vector<double> mixed = draw(neighbours[3]);  // wrong on purpose: a correlation of 0.03
  for (size_t i = 0; i < kDraws; ++i) mixed[i] += 0.03 * base[i];
  EXPECT_GT(std::abs(NormalizedCorrelation(base, mixed)), limit) << "no power";
}

}  // namespace
}  // namespace rcme
