#include "experiments/study/tuning_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>

#include "estimator/estimator_registry.h"
#include "experiments/study/command_permission.h"
#include "experiments/study/study_keys.h"
#include "parameters/suggestion.h"

namespace rcme {
namespace {

// Returns the number of decimal places of a number in its shortest form: 3 for 0.125.
int DecimalPlaces(double value) {
  char text[32];
  const char* end = std::to_chars(text, text + sizeof(text), value, std::chars_format::scientific).ptr;
  const char* e = std::find<const char*>(text, end, 'e');  // d[.ddd]e[+-]dd
  const auto num_digits = std::max<std::ptrdiff_t>(e - text - (text[0] == '-') - 2, 0);
  return std::max(static_cast<int>(num_digits) - std::atoi(std::string(e + 1, end).c_str()), 0);
}

// Returns the levels from, from + step, ..., to.
struct Steps {
  double from = 0.0, to = 0.0, step = 0.0;

  bool IsTooFine() const { return !((to - from) / step < static_cast<double>(kMaxTunedSettings)); }
  // A sum of decimals has no more places than its terms. Rounding to them makes 0.1 + 2 * 0.1 equal 0.3.
  std::vector<std::string> Levels() const {
    const int places = std::max(DecimalPlaces(from), DecimalPlaces(step));
    std::vector<std::string> levels;
    for (size_t i = 0; i <= kMaxTunedSettings; ++i) {
      const std::string text = fmt::format("{:.{}f}", from + static_cast<double>(i) * step, places);
      double level = 0.0;
      if (!ParseReal(text, &level) || level > to) break;
      levels.push_back(fmt::format("{}", level));
    }
    return levels;
  }
};

std::vector<Parameter> Parameters(Steps& steps) {
  return {Parameter::Real("from", &steps.from, {}, "", "the first level"),
          Parameter::Real("to", &steps.to, {}, "", "no level is greater"),
          Parameter::Real("step", &steps.step, {}, "", "from level to level")};
}

std::vector<std::string> SteppedLevels(const Place& place, const YAML::Node& node, const std::string& name) {
  Steps steps;
  const auto entries = Entries(place, node, name, {"from", "to", "step"});
  for (const auto& [key, value] : entries) {
    place.At(value, [&, key = key, value = value] {
      FindParameter(Parameters(steps), key).SetFromText(Scalar(place, value, key));
    });
  }
  if (entries.size() < 3) place.Fail(node, fmt::format("{}: keys from, to and step are needed", name));
  if (!(steps.step > 0.0)) {
    place.Fail(node["step"],
               fmt::format("{}: step: '{}' is not allowed; give a number > 0", name, node["step"].Scalar()));
  }
  if (steps.from > steps.to) {
    place.Fail(node, fmt::format("{}: from: '{}' is not allowed; give a number <= to, which is {}", name,
                                 node["from"].Scalar(), node["to"].Scalar()));
  }
  if (steps.IsTooFine()) {
    place.Fail(node["step"], fmt::format("{}: step: '{}' makes more than {} levels; give a greater one", name,
                                         node["step"].Scalar(), kMaxTunedSettings));
  }
  return steps.Levels();
}

// Returns the text of each level with its node; for levels by steps the node is the whole map.
std::vector<std::pair<std::string, YAML::Node>> GivenLevels(const Place& place, const YAML::Node& node,
                                                            const std::string& name) {
  std::vector<std::pair<std::string, YAML::Node>> levels;
  if (node.IsMap()) {
    for (const std::string& level : SteppedLevels(place, node, name)) levels.emplace_back(level, node);
    return levels;
  }
  if (!node.IsSequence() || node.size() == 0) {
    place.Fail(node, fmt::format("{}: a list of at least one level is needed, or {{from: 0, to: 12, step: "
                                 "0.5}}",
                                 name));
  }
  for (const YAML::Node& level : node) levels.emplace_back(Scalar(place, level, name), level);
  return levels;
}

// Formats the levels as the option does, so equal values are equal texts.
TunedOption ReadOption(const Place& place, const YAML::Node& node, const std::string& option,
                       const EstimatorSpec& spec) {
  TunedOption tuned{option, {}};
  const std::string name = "tune: options: " + option;
  const std::unique_ptr<EstimatorModel> model = Configure(spec);
  const std::vector<Parameter> parameters = model->Parameters();
  place.At(node, [&] { FindOption(spec.name, parameters, option); });
  if (IsCommand(spec, option))
    place.Fail(node, name + ": a command, or a file that may bring one, cannot be tuned; leave it out");
  const Parameter& parameter = FindOption(spec.name, parameters, option);
  std::set<std::string> seen;
  for (const auto& [text, line] : GivenLevels(place, node, name)) {
    place.At(line, [&, text = text] { parameter.SetFromText(text); });
    if (!seen.insert(parameter.Value()).second)
      place.Fail(line, fmt::format("{}: level '{}' stands twice", name, text));
    tuned.levels.push_back(parameter.Value());
  }
  return tuned;
}

std::vector<TunedOption> ReadOptions(const Place& place, const YAML::Node& node, const EstimatorSpec& spec) {
  std::vector<TunedOption> options;
  size_t num_settings = 1;
  for (const auto& [option, levels] : Entries(place, node, "tune: options", {})) {
    options.push_back(ReadOption(place, levels, option, spec));
    num_settings *= options.back().levels.size();
    if (num_settings > kMaxTunedSettings) {
      place.Fail(levels, fmt::format("tune: options: more than {} combinations of levels; give fewer levels",
                                     kMaxTunedSettings));
    }
  }
  if (options.empty()) place.Fail(node, "tune: options: at least one option with its levels is needed");
  return options;
}

}  // namespace

const EstimatorSpec& TunedEstimator(const Tuning& tuning, const std::vector<EstimatorSpec>& estimators) {
  const auto spec = std::ranges::find(estimators, tuning.estimator, &EstimatorSpec::label);
  if (spec != estimators.end()) return *spec;
  const std::vector<std::string> labels = ListLabels(estimators);
  throw InputError(fmt::format("tune: estimator: '{}' is no label of the study{}; give one of: {}",
                               tuning.estimator, DidYouMean(tuning.estimator, labels),
                               fmt::join(labels, ", ")));
}

Tuning ReadTuning(const Place& place, const YAML::Node& node, const std::vector<EstimatorSpec>& estimators) {
  Tuning tuning;
  const std::vector<Parameter> parameters = Parameters(tuning);
  for (const auto& [key, value] : Entries(place, node, "tune", ListStudyKeys("tune"))) {
    if (key == "options") continue;
    place.At(value, [&, key = key, value = value] {
      FindParameter(parameters, key).SetFromText(Scalar(place, value, "tune: " + key));
    });
  }
  for (const char* key : {"estimator", "options"}) {
    if (!node[key]) place.Fail(node, fmt::format("tune: key '{}' is missing", key));
  }
  place.At(node["estimator"], [&] { TunedEstimator(tuning, estimators); });
  tuning.options = ReadOptions(place, node["options"], TunedEstimator(tuning, estimators));
  place.At(node["options"], [&] { CheckCombinations(tuning, estimators); });
  return tuning;
}

void CheckCombinations(const Tuning& tuning, const std::vector<EstimatorSpec>& estimators) {
  const EstimatorSpec& spec = TunedEstimator(tuning, estimators);
  const std::unique_ptr<EstimatorModel> model = Configure(spec);
  const std::vector<Parameter> parameters = model->Parameters();
  std::vector<const Parameter*> tuned;
  for (const TunedOption& option : tuning.options) {
    tuned.push_back(&FindOption(spec.name, parameters, option.name));
  }
  for (size_t i = 0; i < NumSettings(tuning); ++i) {
    const std::vector<std::string> levels = LevelsOfSetting(tuning, i);
    for (size_t o = 0; o < levels.size(); ++o) tuned[o]->SetFromText(levels[o]);
    try {
      model->Make();
    } catch (const InputError& error) {
      std::vector<std::string> names;
      for (size_t o = 0; o < levels.size(); ++o) names.push_back(tuned[o]->name() + ": " + levels[o]);
      throw InputError(fmt::format("tune: options: {}: the combination {{{}}} contradicts itself: {}",
                                   spec.label, fmt::join(names, ", "), error.what()));
    }
  }
}

}  // namespace rcme
