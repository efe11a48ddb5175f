// Whether what a study says can be, and in the words of the parameters themselves.
#pragma once

#include <string>

#include "experiments/core/files/yaml_input.h"
#include "experiments/study/study.h"

namespace rcme {

// A study's settings with the first level of every factor: enough to know which keys there are.
Settings ChooseFirstSettings(const Study& study);

// The value of a setting as its parameter writes it, so that equal values are equal texts.
std::string MakeCanonical(Settings settings, const std::string& key, const std::string& value);

// Data settings are checked one by one, each with the study's choices, so that an error names its line; then
// each level of each factor. All become canonical.
void SettleData(const Place& place, const YAML::Node& root, Study* study);

}  // namespace rcme
