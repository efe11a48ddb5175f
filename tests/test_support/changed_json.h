// A JSON file with something changed in it.
#pragma once

#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "experiments/base/file_output.h"

namespace rcme {

inline nlohmann::ordered_json JsonOf(const std::string& path) {
  return nlohmann::ordered_json::parse(std::ifstream(path));
}

// The path of the changed copy, beside the file; one at a time.
inline std::string ChangedJson(const std::string& path,
                               const std::function<void(nlohmann::ordered_json*)>& change) {
  nlohmann::ordered_json json = JsonOf(path);
  change(&json);
  std::string changed = path;
  changed += ".changed";
  WriteFileWhole(changed, json.dump());
  return changed;
}

}  // namespace rcme
