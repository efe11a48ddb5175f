// An estimator with its options as a map of YAML: an entry of a study's list, or a file (estimator_file.h).
#pragma once

#include "experiments/core/files/yaml_input.h"
#include "experiments/study/study.h"

namespace rcme {

// Reads {name, label, options, budget_ms, provenance}; the label is the name if it is missing, the provenance
// is for people. `block` is what the messages call the map; they list the keys that the caller reads, too.
EstimatorSpec ReadEstimatorEntry(const Place& place, const YAML::Node& node, const std::string& block,
                                 const std::set<std::string>& keys_of_caller = {});

// The keys name, label, options and budget_ms, with every option written out, into the map that is open.
void WriteEstimatorKeys(const EstimatorSpec& spec, YAML::Emitter* out);

}  // namespace rcme
