#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "estimator/estimator_registry.h"
#include "peers/peer_registry.h"
#include "tests/test_support/estimator_variants.h"

namespace rcme {

// The estimators of other libraries, added once.
inline const std::vector<EstimatorEntry>& PeerEntries() {
  static const std::vector<EstimatorEntry> entries = [] {
    AddPeers();
    std::vector<EstimatorEntry> peers = EstimatorRegistry();
    std::erase_if(peers, [](const EstimatorEntry& entry) { return !entry.is_peer; });
    return peers;
  }();
  return entries;
}

inline bool IsOfAPeer(const EstimatorVariant& variant) { return FindEstimator(variant.estimator).is_peer; }

// The options that choose one of several words.
inline std::vector<std::string> ChoicesOfPeers() {
  std::vector<std::string> choices;
  for (const EstimatorEntry& entry : PeerEntries()) {
    const std::unique_ptr<EstimatorModel> model = entry.make();
    for (const Parameter& option : model->Parameters()) {
      if (!ListChoiceWords(option).empty() && std::ranges::count(choices, option.name()) == 0)
        choices.push_back(option.name());
    }
  }
  return choices;
}

// Each peer with every combination of its choices.
inline std::vector<EstimatorVariant> PeerCombinations() {
  std::vector<EstimatorVariant> variants = EstimatorVariants(ChoicesOfPeers());
  std::erase_if(variants, std::not_fn(IsOfAPeer));
  return variants;
}

// Each peer with its defaults, and with every word of one choice at a time.
inline std::vector<EstimatorVariant> PeerVariants() {
  std::vector<EstimatorVariant> all;
  for (const std::string& choice : ChoicesOfPeers()) {
    for (const EstimatorVariant& variant : EstimatorVariants({choice})) {
      const auto has_its_name = [&](const EstimatorVariant& v) { return v.name == variant.name; };
      if (IsOfAPeer(variant) && std::ranges::none_of(all, has_its_name)) all.push_back(variant);
    }
  }
  return all;
}

// What is done with a library's answer, as with any estimator's; the other options are of the library's call.
inline bool IsOfTheAnswer(const std::string& option) {
  return option == "covariance" || option == "model_choice" || option == "planar_scenes";
}

// Those of PeerVariants() that differ in the library's call.
inline std::vector<EstimatorVariant> PeerLibraryCalls() {
  std::vector<EstimatorVariant> calls = PeerVariants();
  std::erase_if(calls, [](const EstimatorVariant& variant) {
    return std::ranges::any_of(variant.options,
                               [](const auto& option) { return IsOfTheAnswer(option.first); });
  });
  return calls;
}

}  // namespace rcme
