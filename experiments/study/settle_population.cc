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

bool Has(const Settings& resolved, const Settings& with) {
  return std::ranges::all_of(with,
                             [&](const auto& choice) { return std::ranges::count(resolved, choice) > 0; });
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

}  // namespace rcme
