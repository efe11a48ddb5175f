#include "experiments/real/truth_free/pair_answers.h"

#include <map>
#include <string>

namespace rcme {

std::vector<ImageNumbers> NumberImages(const std::vector<PairAnswers>& answers) {
  std::map<std::string, std::int64_t> number_of;
  std::int64_t next = 0;
  const auto number = [&](const std::string& image) {
    const auto [at, is_new] = number_of.try_emplace(image, next);
    next += is_new;
    return at->second;
  };
  std::vector<ImageNumbers> numbers;
  for (const PairAnswers& each : answers) {
    const NamedPair& pair = each.whole.pair;
    if (pair.image1.empty() || pair.image2.empty()) {
      numbers.push_back({next, next});
      ++next;
    } else {
      const std::int64_t first = number(pair.image1);
      numbers.push_back({first, number(pair.image2)});
    }
  }
  return numbers;
}

}  // namespace rcme
