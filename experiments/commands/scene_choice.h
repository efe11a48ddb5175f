// The option --scene of commands that work on the pairs of scenes.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>

#include "parameters/input_error.h"

namespace rcme {

// Keeps only the named scene, or all if the name is empty. `name_of` gives the name of an element. Returns
// the names of all that there were, separated by commas. Throws InputError if none is left.
template <typename Scenes, typename NameOf>
std::string KeepScene(const std::string& scene, const NameOf& name_of, Scenes* scenes) {
  std::string names;
  for (const auto& each : *scenes) names += (names.empty() ? "" : ", ") + std::invoke(name_of, each);
  if (scene.empty()) return names;
  std::erase_if(*scenes, [&](const auto& each) { return std::invoke(name_of, each) != scene; });
  if (scenes->empty())
    throw InputError(fmt::format("--scene: there is no scene '{}'; give one of: {}", scene, names));
  return names;
}

}  // namespace rcme
