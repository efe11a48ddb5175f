// What a `data:` block says, as keys and values.
#pragma once

#include <string>

#include "parameters/settings.h"

namespace rcme {

// One key of a `data:` block, for people.
struct SettingHelp {
  std::string name, value, unit, allowed, doc;

  // As Parameter::Integer says what it allows.
  bool IsWholeNumber() const { return allowed.starts_with("a whole number"); }
  // As Parameter::Choice and Parameter::Text do not.
  bool IsNumber() const { return IsWholeNumber() || allowed.starts_with("a number"); }
};

}  // namespace rcme
