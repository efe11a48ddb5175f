// Checks that the settings of a study are possible, and makes them canonical: formatted by their parameters.
#pragma once

#include <string>

#include "experiments/core/files/yaml_input.h"
#include "experiments/study/study.h"

namespace rcme {

// Returns a study's settings with the first level of every factor: enough to know which keys exist.
Settings ChooseFirstSettings(const Study& study);

// Returns the value of a setting as its parameter formats it, so equal values are equal texts.
std::string MakeCanonical(Settings settings, const std::string& key, const std::string& value);

// Checks the data settings one by one, each together with the study's choices, so an error names its line;
// then each level of each factor, and the population. All become canonical.
void SettleData(const Place& place, const YAML::Node& root, Study* study);

}  // namespace rcme
