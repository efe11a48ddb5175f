// The estimators of the registry, each in every reading and implementation that it lets one choose.
#pragma once

#include <algorithm>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
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

// Adds a setting, and covariance=robust where it has no effect without. Returns false if the variant has
// another covariance.
inline bool AddSetting(const std::string& option, const std::string& word, EstimatorVariant* variant) {
  variant->options.emplace_back(option, word);
  if (option != "covariance_jackknife" || word == "off") return true;
  const auto covariance = std::ranges::find(variant->options, "covariance", &Settings::value_type::first);
  if (covariance != variant->options.end()) return covariance->second == "robust";
  variant->options.emplace_back("covariance", "robust");
  return true;
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
          EstimatorVariant next{variant.name + "_" + word, variant.estimator, variant.options};
          if (AddSetting(option.name(), word, &next)) more.push_back(std::move(next));
        }
      }
      variants = std::move(more);
    }
    all.insert(all.end(), variants.begin(), variants.end());
  }
  return all;
}

}  // namespace rcme
