// The registries of the simulator: scenes, motions, camera pairs, noise laws and outlier laws, one line each.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "parameters/input_error.h"
#include "parameters/suggestion.h"

namespace rcme {

template <typename Model>
struct RegistryEntry {
  std::string name;
  std::string doc;
  std::function<std::unique_ptr<Model>()> make;  // with default parameters
};

// The entry called `name`. Throws InputError that names `key` and lists the known names.
template <typename Entry>
const Entry& FindEntry(const std::vector<Entry>& registry, const std::string& key, const std::string& name) {
  const auto entry = std::ranges::find(registry, name, &Entry::name);
  if (entry != registry.end()) return *entry;
  const std::vector<std::string> names = ListNames(registry);
  throw InputError(fmt::format("{}: '{}' is not allowed{}; give one of: {}", key, name,
                               DidYouMean(name, names), fmt::join(names, ", ")));
}

}  // namespace rcme
