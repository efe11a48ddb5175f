#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "simulator/scene.h"

namespace rcme {

// One line per scene; studies, `rcme list` and the contract tests read this table.
struct SceneEntry {
  std::string name;
  std::string doc;
  std::function<std::unique_ptr<SceneModel>()> make;  // with default parameters
};
const std::vector<SceneEntry>& SceneRegistry();

// The entry called `name`, or null.
const SceneEntry* FindScene(const std::string& name);

}  // namespace rcme
