// An estimator with its options as a YAML map: an entry of a study's list, or a whole file
// (estimator_file.h).
#pragma once

#include "experiments/core/files/yaml_input.h"
#include "experiments/study/study.h"

namespace rcme {

// Reads {name, label, options, budget_ms, provenance}. The label defaults to the name; the provenance is for
// people and is not kept. `block` is the name of the map in messages, which also list the keys that the
// caller reads itself.
EstimatorSpec ReadEstimatorEntry(const Place& place, const YAML::Node& node, const std::string& block,
                                 const std::set<std::string>& keys_of_caller = {});

// Reads the label of an estimator: a name without commas.
std::string ReadLabel(const Place& place, const YAML::Node& node);

// Throws InputError unless an estimator has this name. The message suggests one, and lists estimators and
// estimator files.
void RequireEstimatorName(const std::string& name);

// Says which estimators this build lacks and how to get them: a sentence, or empty.
std::string DescribeLeftOut();

// Returns whether only a file that comes with the program has this name, and no estimator.
bool IsNameOfEstimatorFile(const std::string& name);

// Writes the keys name, label, options and budget_ms into the open map, with the value of every option.
void WriteEstimatorKeys(const EstimatorSpec& spec, YAML::Emitter* out);

}  // namespace rcme
