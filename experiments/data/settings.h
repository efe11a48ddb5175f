// A `data:` block as keys and values.
#pragma once

#include <string>

#include "parameters/settings.h"

namespace rcme {

// Describes one key of a `data:` block for people.
struct SettingHelp {
  std::string name, value, unit, allowed, doc;

  // Parameter::Integer describes its range with these words.
  bool IsWholeNumber() const { return allowed.starts_with("a whole number"); }
  // Parameter::Choice and Parameter::Text do not.
  bool IsNumber() const { return IsWholeNumber() || allowed.starts_with("a number"); }
};

}  // namespace rcme
