// The estimators of the registry, each in every reading and implementation that it lets one choose.
#pragma once

#include <algorithm>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "estimator/estimator_registry.h"

namespace rcme {

struct EstimatorVariant {
  std::string name;  // rcme_rank_aware_fast
  std::string estimator;
  Settings options;

  std::unique_ptr<MotionEstimator> Make() const { return MakeEstimator(estimator, options); }
};

inline void PrintTo(const EstimatorVariant& variant, std::ostream* out) { *out << variant.name; }

// The words of a choice.
inline std::vector<std::string> ListChoiceWords(const Parameter& option) {
  const std::string beginning = "one of: ";
  std::vector<std::string> words;
  if (!option.allowed().starts_with(beginning)) return words;
  std::istringstream list(option.allowed().substr(beginning.size()));
  for (std::string word; std::getline(list >> std::ws, word, ',');) words.push_back(word);
  return words;
}

inline std::vector<EstimatorVariant> EstimatorVariants(const std::vector<std::string>& chosen = {
                                                           "reading", "implementation"}) {
  std::vector<EstimatorVariant> all;
  for (const EstimatorEntry& entry : EstimatorRegistry()) {
    std::vector<EstimatorVariant> variants = {{entry.name, entry.name, {}}};
    const std::unique_ptr<EstimatorModel> model = entry.make();
    for (const Parameter& option : model->Parameters()) {
      if (std::ranges::find(chosen, option.name()) == chosen.end()) continue;
      std::vector<EstimatorVariant> more;
      for (const EstimatorVariant& variant : variants) {
        for (const std::string& word : ListChoiceWords(option)) {
          more.push_back({variant.name + "_" + word, variant.estimator, variant.options});
          more.back().options.emplace_back(option.name(), word);
        }
      }
      variants = std::move(more);
    }
    all.insert(all.end(), variants.begin(), variants.end());
  }
  return all;
}

}  // namespace rcme
