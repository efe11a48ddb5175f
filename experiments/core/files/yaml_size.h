#pragma once

#include <string>

#include "experiments/core/files/yaml_input.h"

namespace rcme {

// Throws InputError with file and line if `yaml` holds more than one document, lists and maps nested deeper
// than 20 levels, a text of more than 10,000 bytes, or more than 20,000 values. An alias (*a) counts as the
// values that it stands for. Nothing is built, so a few lines cannot fill memory. Throws YAML::Exception.
void CheckYamlSize(const std::string& yaml, const Place& place);

}  // namespace rcme
