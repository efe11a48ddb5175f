// The hash FNV-1a of Fowler, Noll and Vo (RFC 9923). It names random streams after texts and detects changed
// data; it is not cryptographic.
#pragma once

#include <bit>
#include <cstdint>
#include <string_view>

namespace rcme {

template <typename Word, Word kOffsetBasis, Word kPrime>
class BasicFnv1a {
 public:
  // Byte by byte, as published: a text added in two parts has the hash of the whole.
  void Add(std::string_view bytes) {
    for (const char byte : bytes) AddWord(static_cast<unsigned char>(byte));
  }
  // The bits of a number in one step; the hash differs from that of its eight bytes.
  void Add(double number) requires(sizeof(Word) == sizeof(double)) { AddWord(std::bit_cast<Word>(number)); }

  Word value() const { return hash_; }

 private:
  void AddWord(Word word) { hash_ = (hash_ ^ word) * kPrime; }

  Word hash_ = kOffsetBasis;
};

using Fnv1a = BasicFnv1a<std::uint64_t, 0xcbf29ce484222325, 0x100000001b3>;
using Fnv1a32 = BasicFnv1a<std::uint32_t, 0x811c9dc5, 0x01000193>;

// A 48-bit condition of a random stream (random.h) named after a text.
inline std::uint64_t HashToStreamKey(std::string_view text) {
  Fnv1a hash;
  hash.Add(text);
  return (hash.value() >> 48 ^ hash.value()) & 0xffff'ffff'ffff;
}

}  // namespace rcme
