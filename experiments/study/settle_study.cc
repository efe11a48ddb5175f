#include "experiments/study/settle_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "experiments/core/files/yaml_input.h"
#include "experiments/data/calibration_file.h"
#include "experiments/data/make_data.h"
#include "experiments/study/command_permission.h"
#include "experiments/study/study.h"
#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "parameters/plain_text.h"
#include "parameters/settings.h"
#include "parameters/suggestion.h"

namespace rcme {
namespace {

// Runs `check` and adds the place of the key to an InputError from it.
template <typename Check>
void AtKey(const DrawnKey& drawn, Check check) {
  try {
    check();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", drawn.place, error.what()));
  }
}

bool Has(const Settings& resolved, const Settings& with) {
  return std::ranges::all_of(with,
                             [&](const auto& choice) { return std::ranges::count(resolved, choice) > 0; });
}

// Returns the settings of a possible draw: `data` and the first word of each choice.
Settings ChooseFirstDraw(const Study& study) {
  Settings settings = study.data;
  if (!study.population) return settings;
  for (const DrawnKey& drawn : study.population->keys) {
    if (IsChoice(drawn.key) && Has(settings, drawn.with))
      settings.emplace_back(drawn.key, drawn.range.words.front());
  }
  return settings;
}

// Settings that can be drawn, and what they resolve to.
using PossibleDraw = std::pair<Settings, Settings>;

// Resolves the draw of all first words. An error is that of the choice whose name begins it, or else of all.
PossibleDraw ResolveFirstDraw(const Place& place, const YAML::Node& node, const Study& study) {
  const Settings first = ChooseFirstDraw(study);
  try {
    return {first, ResolveSettings(first)};
  } catch (const InputError& error) {
    for (const DrawnKey& drawn : study.population->keys) {
      const bool is_of_key = std::string(error.what()).starts_with(drawn.key + ": ");
      if (is_of_key && IsChoice(drawn.key) && Has(first, drawn.with)) AtKey(drawn, [&] { throw error; });
    }
    place.Fail(node, error.what());
  }
}

// Returns possible draws: `first`, and for each word of one choice the same with that word.
std::vector<PossibleDraw> ListPossibleDraws(const PossibleDraw& first, const Population& population) {
  std::vector<PossibleDraw> all = {first};
  for (const DrawnKey& drawn : population.keys) {
    if (!IsChoice(drawn.key)) continue;
    for (const std::string& word : drawn.range.words) {
      Settings settings = first.first;
      settings.insert(settings.end(), drawn.with.begin(), drawn.with.end());
      settings.emplace_back(drawn.key, word);
      AtKey(drawn, [&] { all.emplace_back(settings, ResolveSettings(settings)); });
    }
  }
  return all;
}

// Throws InputError for a choice that cannot be drawn from these words.
void CheckWords(const DrawnKey& drawn) {
  if (!IsChoice(drawn.key)) return;
  for (const std::string& word : drawn.range.words) {
    if (word == kMatchFilesScene || word == kCamerasFromFile)
      throw InputError(fmt::format("ranges: {}: {} cannot be drawn", drawn.key, word));
  }
  if (drawn.range.words.empty())
    throw InputError(fmt::format("ranges: {}: names are needed, not numbers", drawn.key));
}

// Checks the ends of the key's range with all elements of `possible` that have the key. Words become
// canonical.
void SettleKey(const std::vector<PossibleDraw>& possible, DrawnKey* drawn) {
  bool is_anywhere = false;
  for (const auto& [settings, resolved] : possible) {
    if (!FindSetting(resolved, drawn->key) || !Has(resolved, drawn->with)) continue;
    is_anywhere = true;
    const auto canonical = [&, &settings = settings](const std::string& value) {
      Settings with_it = settings;
      with_it.emplace_back(drawn->key, value);
      return FindSetting(ResolveSettings(with_it), drawn->key).value();
    };
    for (std::string& word : drawn->range.words) word = canonical(word);
    if (drawn->range.kind == DrawnRange::Kind::kAnyOf) continue;
    for (const double end : {drawn->range.from, drawn->range.to}) canonical(fmt::format("{}", end));
  }
  if (is_anywhere) return;
  std::string where;
  for (const auto& [choice, name] : drawn->with) where += fmt::format(" with {}: {}", choice, name);
  throw InputError(
      fmt::format("ranges: {}: no draw has this key{}{}", drawn->key, where, ChoicesWith(drawn->key)));
}

// A side of a restriction must be a number or a key, of a draw or at least of some scene, law or camera: a
// name that is none would restrict nothing.
void CheckSide(const std::vector<PossibleDraw>& possible, const Restriction& restriction,
               const std::string& side) {
  double number = 0.0;
  if (ParseReal(side, &number) || !ChoicesWith(side).empty()) return;
  std::vector<std::string> keys;
  for (const auto& [settings, resolved] : possible) {
    for (const auto& [key, value] : resolved) keys.push_back(key);
  }
  if (std::ranges::count(keys, side) > 0) return;
  throw InputError(fmt::format("given: {}: there is no key {}{}", restriction.Text(), Quoted(side),
                               DidYouMean(side, keys)));
}

// Throws InputError with the line of `node` unless every drawn key exists, and both ends of its range are
// allowed, with every scene and law with which it may be drawn. A key in `data` that one of these lacks is
// an error too. Words and fixed numbers become canonical: as their parameters format them.
void SettlePopulation(const Place& place, const YAML::Node& node, Study* study) {
  std::vector<DrawnKey>& keys = study->population->keys;
  for (const DrawnKey& drawn : keys) AtKey(drawn, [&] { CheckWords(drawn); });
  const std::vector<PossibleDraw> possible =
      ListPossibleDraws(ResolveFirstDraw(place, node, *study), *study->population);
  for (DrawnKey& drawn : keys) AtKey(drawn, [&] { SettleKey(possible, &drawn); });
  place.At(node["given"] ? node["given"] : node, [&] {
    for (const Restriction& restriction : study->population->given) {
      CheckSide(possible, restriction, restriction.left);
      CheckSide(possible, restriction, restriction.right);
    }
  });
}

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
