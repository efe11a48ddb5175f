// What a `data:` block says, as keys and values.
#pragma once

#include <string>

#include "parameters/settings.h"

namespace rcme {

// One key of a `data:` block, for people.
struct SettingHelp {
  std::string name, value, unit, allowed, doc;
};

}  // namespace rcme
