// The ranges of a population in a file: what each key may be, and with which names it is drawn
// (population_file.h shows the forms).
#pragma once

#include <string>
#include <vector>

#include "experiments/core/files/yaml_input.h"
#include "experiments/study/population.h"

namespace rcme {

// Words or numbers, at least one.
std::vector<std::string> ReadWords(const Place& place, const YAML::Node& node, const std::string& key);

// `name`: of the block, for messages.
std::vector<DrawnKey> ReadRanges(const Place& place, const YAML::Node& node, const std::string& name);

// ReadRanges gives the same back.
void WriteRanges(const std::vector<DrawnKey>& keys, YAML::Emitter* out);

}  // namespace rcme
