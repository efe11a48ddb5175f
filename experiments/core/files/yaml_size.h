#pragma once

#include <string>

#include "experiments/core/files/yaml_input.h"

namespace rcme {

// Throws InputError with file and line if `yaml` is more than one document, or holds lists and maps within
// each other deeper than 20 levels, a text of more than 10,000 bytes, or more than 20,000 values, where an
// alias (*a) counts as what it stands for. Nothing is built, so that few lines cannot fill memory. Throws
// YAML::Exception.
void CheckYamlSize(const std::string& yaml, const Place& place);

}  // namespace rcme
