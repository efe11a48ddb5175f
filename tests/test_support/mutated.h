// Damaged copies of an input: some bytes changed, cut out, doubled, or replaced by a word that has harmed a
// reader.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "stats/random.h"

namespace rcme {

// `bytes` with one to eight changes; a pure function of the stream. `words` are put in now and then.
inline std::string Mutated(std::string bytes, const std::vector<std::string>& words, RandomStream& rng) {
  const auto below = [&rng](size_t n) {
    return std::min(static_cast<size_t>(rng.Uniform() * static_cast<double>(n)), n - 1);
  };
  for (size_t change = 0, num_changes = 1 + below(8); change < num_changes; ++change) {
    const size_t at = below(bytes.size() + 1);
    const size_t length = std::min(below(40), bytes.size() - at);
    switch (below(6)) {
      case 0:
        if (at < bytes.size()) bytes[at] = static_cast<char>(below(256));
        break;
      case 1:
        if (at < bytes.size()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 2:
        bytes.erase(at, length);
        break;
      case 3:
        bytes.insert(below(bytes.size() + 1), bytes.substr(at, length));
        break;
      case 4:
        bytes.insert(at, words[below(words.size())]);
        break;
      default:
        bytes.replace(at, length, words[below(words.size())]);
    }
  }
  return below(20) == 0 ? bytes.substr(0, below(bytes.size() + 1)) : bytes;
}

}  // namespace rcme
