#include "stats/fnv1a.h"

#include <gtest/gtest.h>

#include <string>

namespace rcme {
namespace {

template <typename Hash>
auto ComputeHash(std::string_view text) {
  Hash hash;
  hash.Add(text);
  return hash.value();
}

// The values of the authors' own test vectors (test_fnv.c), with bytes beyond 127 and zeros.
TEST(Fnv1aTest, HashesAreThePublishedOnes) {
  EXPECT_EQ(ComputeHash<Fnv1a>(""), 0xcbf29ce484222325u);
  EXPECT_EQ(ComputeHash<Fnv1a>("a"), 0xaf63dc4c8601ec8cu);
  EXPECT_EQ(ComputeHash<Fnv1a>("foobar"), 0x85944171f73967e8u);
  EXPECT_EQ(ComputeHash<Fnv1a>("chongo was here!\n"), 0x46810940eff5f915u);
  EXPECT_EQ(ComputeHash<Fnv1a>(std::string_view("\xff\x00\x00\x01", 4)), 0x6961196491cc682du);
  EXPECT_EQ(ComputeHash<Fnv1a32>(""), 0x811c9dc5u);
  EXPECT_EQ(ComputeHash<Fnv1a32>("a"), 0xe40c292cu);
  EXPECT_EQ(ComputeHash<Fnv1a32>("foobar"), 0xbf9cf968u);
  EXPECT_EQ(ComputeHash<Fnv1a32>("chongo was here!\n"), 0xd49930d5u);
}

TEST(Fnv1aTest, TextInPartsIsTheWhole) {
  Fnv1a parts;
  parts.Add("foo");
  parts.Add("bar");
  EXPECT_EQ(parts.value(), ComputeHash<Fnv1a>("foobar"));
}

// (0xcbf29ce484222325 ^ 0x3ff0000000000000) * 0x100000001b3 mod 2^64, and the same folded, by Python.
TEST(Fnv1aTest, NumberIsOneStepAndStreamKeyIsFolded) {
  Fnv1a one;
  one.Add(1.0);
  EXPECT_EQ(one.value(), 0xc293bd4c8601b7dfu);
  EXPECT_EQ(HashToStreamKey("a"), 0xdc4c860143efu);
}

}  // namespace
}  // namespace rcme
