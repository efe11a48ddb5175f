#include "experiments/study/settle_population.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/data/calibration_file.h"
#include "experiments/data/make_data.h"
#include "parameters/find_setting.h"
#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "parameters/plain_text.h"
#include "parameters/suggestion.h"

namespace rcme {
namespace {

// Returns possible settings: `data` with the first word of each choice, and for each further word of one
// choice the same with that word.
std::vector<Settings> PossibleSettings(const Study& study) {
  const Settings first = ChooseFirstDraw(study);
  std::vector<Settings> all = {first};
  for (const DrawnKey& drawn : study.population->keys) {
    if (!IsChoice(drawn.key)) continue;
    for (const std::string& word : drawn.range.words) {
      Settings settings = first;
      settings.insert(settings.end(), drawn.with.begin(), drawn.with.end());
      settings.emplace_back(drawn.key, word);
      all.push_back(std::move(settings));
    }
  }
  return all;
}

bool Has(const Settings& resolved, const Settings& with) {
  return std::ranges::all_of(with,
                             [&](const auto& choice) { return std::ranges::count(resolved, choice) > 0; });
}

// Checks the ends of the key's range with all elements of `possible` that have the key. Words become
// canonical.
void SettleKey(const std::vector<std::pair<Settings, Settings>>& possible, DrawnKey* drawn) {
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

// A side of a restriction must be a number or a key of some draw: one that no draw has would restrict
// nothing.
void CheckSide(const std::vector<std::pair<Settings, Settings>>& possible, const Restriction& restriction,
               const std::string& side) {
  double number = 0.0;
  if (ParseReal(side, &number)) return;
  std::vector<std::string> keys;
  for (const auto& [settings, resolved] : possible) {
    for (const auto& [key, value] : resolved) keys.push_back(key);
  }
  if (std::ranges::count(keys, side) > 0) return;
  throw InputError(fmt::format("given: {}: no draw has the key {}{}", restriction.Text(), Quoted(side),
                               DidYouMean(side, keys)));
}

}  // namespace

Settings ChooseFirstDraw(const Study& study) {
  Settings settings = study.data;
  if (!study.population) return settings;
  for (const DrawnKey& drawn : study.population->keys) {
    if (IsChoice(drawn.key) && Has(settings, drawn.with))
      settings.emplace_back(drawn.key, drawn.range.words.front());
  }
  return settings;
}

void SettlePopulation(const Place& place, const YAML::Node& node, Study* study) {
  place.At(node, [&] {
    for (const DrawnKey& drawn : study->population->keys) {
      const std::vector<std::string> words =
          IsChoice(drawn.key) ? drawn.range.words : std::vector<std::string>();
      for (const std::string& word : words) {
        if (word == kMatchFilesScene || word == kCamerasFromFile)
          throw InputError(fmt::format("ranges: {}: {} cannot be drawn", drawn.key, word));
      }
      if (IsChoice(drawn.key) && words.empty())
        throw InputError(fmt::format("ranges: {}: names are needed, not numbers", drawn.key));
    }
    std::vector<std::pair<Settings, Settings>> possible;
    for (const Settings& settings : PossibleSettings(*study))
      possible.emplace_back(settings, ResolveSettings(settings));
    for (DrawnKey& drawn : study->population->keys) SettleKey(possible, &drawn);
    for (const Restriction& restriction : study->population->given) {
      CheckSide(possible, restriction, restriction.left);
      CheckSide(possible, restriction, restriction.right);
    }
  });
}

}  // namespace rcme
