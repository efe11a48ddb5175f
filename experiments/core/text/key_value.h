// Arguments of the form KEY=VALUE.
#pragma once

#include <algorithm>
#include <string>

namespace rcme {

struct KeyValue {
  std::string key, value;
  bool has_equals = false;
};

// Splits at the first '='. Without one, the whole text is the key.
inline KeyValue SplitKeyValue(const std::string& text) {
  const size_t equals = std::min(text.find('='), text.size());
  const bool has_equals = equals < text.size();
  return {text.substr(0, equals), has_equals ? text.substr(equals + 1) : "", has_equals};
}

}  // namespace rcme
