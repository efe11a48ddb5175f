#include "experiments/study/estimator_entry.h"

#include <fmt/format.h>

#include "estimator/estimator_registry.h"

namespace rcme {
namespace {

void ReadOptions(const Place& place, const YAML::Node& node, RansacOptions* options) {
  for (const auto& [option, text] : Entries(place, node, "options", {})) {
    place.At(text, [&, option = option, text = text] {
      FindParameter(Parameters(*options), option).SetFromText(Scalar(place, text, option));
    });
  }
}

}  // namespace

EstimatorSpec ReadEstimatorEntry(const Place& place, const YAML::Node& node, const std::string& block,
                                 const std::set<std::string>& keys_of_caller) {
  EstimatorSpec spec;
  std::set<std::string> known = {"name", "label", "options", "provenance"};
  known.insert(keys_of_caller.begin(), keys_of_caller.end());
  for (const auto& [key, value] : Entries(place, node, block, known)) {
    if (key == "name") spec.name = Name(place, value, key);
    if (key == "label") spec.label = Name(place, value, key);
    if (key == "options") ReadOptions(place, value, &spec.options);
    if (key != "provenance") continue;
    for (const auto& [what, text] : Entries(place, value, key, {})) Scalar(place, text, what);
  }
  if (spec.name.empty()) place.Fail(node, fmt::format("{}: key 'name' is missing", block));
  if (spec.label.empty()) spec.label = spec.name;
  place.At(node, [&] { FindEstimator(spec.name).make(spec.options); });
  return spec;
}

void WriteEstimatorKeys(EstimatorSpec spec, YAML::Emitter* out) {
  *out << YAML::Key << "name" << YAML::Value << spec.name;
  *out << YAML::Key << "label" << YAML::Value << spec.label;
  *out << YAML::Key << "options" << YAML::Value << YAML::BeginMap;
  for (const Parameter& p : Parameters(spec.options))
    *out << YAML::Key << p.name() << YAML::Value << p.Value();
  *out << YAML::EndMap;
}

}  // namespace rcme
