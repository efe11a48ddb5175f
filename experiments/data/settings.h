// What a `data:` block says, as keys and values.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace rcme {

using Settings = std::vector<std::pair<std::string, std::string>>;  // key, value as text; later ones override

// One key of a `data:` block, for people.
struct SettingHelp {
  std::string name, value, unit, allowed, doc;
};

}  // namespace rcme
