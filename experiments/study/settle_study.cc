#include "experiments/study/settle_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "experiments/data/make_data.h"
#include "experiments/study/command_permission.h"
#include "experiments/study/settle_population.h"
#include "parameters/find_setting.h"
#include "parameters/plain_text.h"
#include "parameters/suggestion.h"

namespace rcme {
namespace {

// Checks the levels of an estimator's option and makes them canonical.
void SettleOption(const Place& place, const YAML::Node& line, const Study& study, Factor* factor) {
  const size_t dot = factor->key.rfind('.');
  const std::string label = factor->key.substr(0, dot), option = factor->key.substr(dot + 1);
  std::vector<std::string> labels;
  for (const EstimatorSpec& spec : study.estimators) {
    labels.push_back(spec.label);
    if (spec.label != label) continue;
    if (IsCommand(spec, option))
      place.Fail(
          line, fmt::format("factors: {}: a command, or a file that may bring one, cannot vary; leave it out",
                            factor->key));
    for (std::string& level : factor->levels) {
      EstimatorSpec varied = spec;
      place.At(line, [&] {
        SetOptions(&varied, {{option, level}});
        Configure(varied)->Make();
      });
      level = FindSetting(varied.options, option).value();
    }
    return;
  }
  place.Fail(line,
             fmt::format("factors: {}: the study has no estimator {}{}; its estimators: {}", factor->key,
                         Quoted(label), DidYouMean(label, labels), fmt::join(labels, ", ")));
}

void RequireDifferentLevels(const Place& place, const YAML::Node& line, const Factor& factor,
                            const std::vector<std::string>& given) {
  std::set<std::string> seen;
  for (size_t i = 0; i < given.size(); ++i) {
    if (!seen.insert(factor.levels[i]).second)
      place.Fail(line, fmt::format("factors: {}: level '{}' stands twice", factor.key, given[i]));
  }
}

// The key of a population that is drawn in every draw; nullptr if there is none of this name.
const DrawnKey* FindDrawnKey(const Study& study, const std::string& key) {
  if (!study.population) return nullptr;
  const std::vector<DrawnKey>& keys = study.population->keys;
  const auto found = std::ranges::find_if(
      keys, [&](const DrawnKey& drawn) { return drawn.key == key && drawn.with.empty(); });
  return found == keys.end() ? nullptr : &*found;
}

}  // namespace

Settings ChooseFirstSettings(const Study& study) {
  Settings settings = ChooseFirstDraw(study);
  for (const Factor& factor : study.factors) {
    if (!IsEstimatorOption(factor.key)) settings.emplace_back(factor.key, factor.levels.front());
  }
  return settings;
}

std::string MakeCanonical(Settings settings, const std::string& key, const std::string& value) {
  settings.emplace_back(key, value);
  return FindSetting(ResolveSettings(settings), key).value();
}

void SettleData(const Place& place, const YAML::Node& root, Study* of) {
  Study& study = *of;
  place.At(root["factors"] ? root["factors"] : root,
           [&] { FactorRows(study); });  // before the work per level
  const auto line_of = [&](const char* block, const std::string& key) -> YAML::Node {
    const YAML::Node map = root[block];
    return map && map.IsMap() && map[key] ? map[key] : root;
  };
  const Settings first = ChooseFirstSettings(study);
  const auto scene = std::ranges::find(first, "scene", &Settings::value_type::first);
  if (scene == first.end())
    place.Fail(root["data"] ? root["data"] : root, "data: key 'scene' is missing (see `rcme list scenes`)");
  Settings choices;
  for (const auto& choice : first) {
    if (!IsChoice(choice.first)) continue;
    choices.push_back(choice);
    const auto check = [&] { ResolveSettings({*scene, choice}); };
    if (const DrawnKey* const drawn = FindDrawnKey(study, choice.first)) {
      AtKey(*drawn, check);
      continue;
    }
    const bool is_in_data = root["data"] && root["data"][choice.first];
    place.At(line_of(is_in_data ? "data" : "factors", choice.first), check);
  }
  for (auto& [key, value] : study.data) {
    place.At(line_of("data", key),
             [&, &key = key, &value = value] { value = MakeCanonical(choices, key, value); });
  }
  for (Factor& factor : study.factors) {
    const YAML::Node line = line_of("factors", factor.key);
    const std::vector<std::string> given = factor.levels;
    if (IsEstimatorOption(factor.key)) {
      SettleOption(place, line, study, &factor);
      RequireDifferentLevels(place, line, factor, given);
      continue;
    }
    for (std::string& level : factor.levels) {
      if (factor.key == "scene" && level == kMatchFilesScene)
        place.Fail(line,
                   "factors: scene: match_files is not a simulated scene; write a separate study for it");
      const std::string text = level;
      place.At(line,
               [&] { level = MakeCanonical(IsChoice(factor.key) ? first : choices, factor.key, text); });
    }
    RequireDifferentLevels(place, line, factor, given);
  }
  if (study.population) SettlePopulation(place, root["conditions"], &study);
}

}  // namespace rcme
