// Reads and writes the ranges of a population: what each key may be, and with which choices it is drawn
// (population_file.h shows the forms).
#pragma once

#include <string>
#include <vector>

#include "experiments/core/files/yaml_input.h"
#include "experiments/study/population.h"

namespace rcme {

// Reads a list of words or numbers, at least one.
std::vector<std::string> ReadWords(const Place& place, const YAML::Node& node, const std::string& key);

// `name` is the name of the block in messages.
std::vector<DrawnKey> ReadRanges(const Place& place, const YAML::Node& node, const std::string& name);

// Writes ranges as ReadRanges reads them.
void WriteRanges(const std::vector<DrawnKey>& keys, YAML::Emitter* out);

}  // namespace rcme
