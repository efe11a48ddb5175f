#include "experiments/study/population_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "experiments/core/files/shared_files.h"
#include "experiments/data/calibration_file.h"
#include "experiments/data/make_data.h"
#include "experiments/study/study_keys.h"
#include "parameters/plain_text.h"
#include "simulator/camera_registry.h"
#include "simulator/motion_registry.h"
#include "simulator/noise_registry.h"
#include "simulator/outlier_registry.h"
#include "simulator/scene_registry.h"

namespace rcme {
namespace {

constexpr const char *kAny = "any", *kLog = "log", *kAnyOf = "any of ", *kLogOf = "log ";
constexpr const char* kComparisons[] = {"<=", ">=", "<", ">"};
constexpr size_t kMaxDepth = 4;  // of words in words

const FileKind& PopulationFileKind() {
  static const FileKind kind = {"population file", "a population of conditions"};
  return kind;
}

template <typename Entry>
std::vector<std::string> NamesOfEntries(const std::vector<Entry>& registry) {
  std::vector<std::string> names;
  for (const Entry& entry : registry) names.push_back(entry.name);
  return names;
}

// The names that a choice of the data has.
std::vector<std::string> NamesOfChoice(const std::string& key) {
  if (key == "scene") return NamesOfEntries(SceneRegistry());
  if (key == "cameras") return NamesOfEntries(CameraRegistry());
  if (key == "motion") return NamesOfEntries(MotionRegistry());
  if (key == "noise") return NamesOfEntries(NoiseRegistry());
  return NamesOfEntries(OutlierRegistry());
}

bool IsNumber(const YAML::Node& node) {
  double value = 0.0;
  return node.IsScalar() && ParseReal(node.Scalar(), &value);
}

std::vector<std::string> Words(const Place& place, const YAML::Node& node, const std::string& key) {
  if (!node.IsSequence() || node.size() == 0)
    place.Fail(node, fmt::format("{}: a list of at least one word or number is needed", key));
  std::vector<std::string> words;
  for (const YAML::Node& word : node) words.push_back(Line(place, word, key));
  return words;
}

// Numbers of draws, ascending, each once.
std::vector<int> ReadDraws(const Place& place, const YAML::Node& node) {
  std::vector<int> draws;
  for (const std::string& word : Words(place, node, "draws")) {
    long long number = 0;
    if (!ParseInteger(word, &number) || number < 0 || number >= kMaxDraws)
      place.Fail(node, fmt::format("draws: {} is not allowed; give whole numbers in [0, {}]", Quoted(word),
                                   kMaxDraws - 1));
    draws.push_back(static_cast<int>(number));
  }
  std::ranges::sort(draws);
  if (std::ranges::adjacent_find(draws) != draws.end())
    place.Fail(node, fmt::format("draws: {} stands there twice", *std::ranges::adjacent_find(draws)));
  return draws;
}

// Two numbers, the first less than the second.
DrawnRange ReadEnds(const Place& place, const YAML::Node& node, const std::string& key,
                    DrawnRange::Kind kind) {
  DrawnRange range{kind, 0.0, 0.0, {}};
  const bool are_two = node.IsSequence() && node.size() == 2 && IsNumber(node[0]) && IsNumber(node[1]);
  if (are_two) {
    ParseReal(node[0].Scalar(), &range.from);
    ParseReal(node[1].Scalar(), &range.to);
  }
  const bool is_log = kind == DrawnRange::Kind::kLogUniform;
  if (!are_two || range.from >= range.to || (is_log && range.from <= 0.0)) {
    place.Fail(node, fmt::format("{}: two numbers are needed, the first {}less than the second: [0.1, 3]",
                                 key, is_log ? "above 0 and " : ""));
  }
  return range;
}

DrawnRange ReadList(const Place& place, const YAML::Node& node, const std::string& key) {
  const bool has_number =
      std::any_of(node.begin(), node.end(), [](const auto& word) { return IsNumber(word); });
  if (!has_number) return {DrawnRange::Kind::kAnyOf, 0.0, 0.0, Words(place, node, key)};
  if (node.size() != 2 || !IsNumber(node[0]) || !IsNumber(node[1])) {
    place.Fail(node, fmt::format(
                         "{}: a range has two numbers, [from, to]; of single ones give {{any: [...]}}", key));
  }
  return ReadEnds(place, node, key, DrawnRange::Kind::kUniform);
}

// "log [0.1, 3]", "any of [a, b]", "any", or what the key always is.
DrawnRange ReadWord(const Place& place, const YAML::Node& node, const std::string& key) {
  const std::string text = Line(place, node, key);
  const auto rest = [&](const char* beginning) {
    try {
      return YAML::Load(text.substr(std::string_view(beginning).size()));
    } catch (const YAML::Exception&) {
      place.Fail(node, fmt::format("{}: {} is not allowed; give {}[..., ...]", key, Quoted(text), beginning));
    }
  };
  const auto at_line = [&](auto read) {  // the rest has no line of its own
    DrawnRange range;
    place.At(node, [&] { range = read(); });
    return range;
  };
  const Place nowhere(place.path());
  if (text.starts_with(kLogOf))
    return at_line([&] { return ReadEnds(nowhere, rest(kLogOf), key, DrawnRange::Kind::kLogUniform); });
  if (text.starts_with(kAnyOf)) {
    return at_line([&] {
      return DrawnRange{DrawnRange::Kind::kAnyOf, 0.0, 0.0, Words(nowhere, rest(kAnyOf), key)};
    });
  }
  if (text != kAny) return {DrawnRange::Kind::kAnyOf, 0.0, 0.0, {text}};
  if (!IsChoice(key)) {
    place.Fail(
        node,
        fmt::format("{}: any is for scene, cameras, motion, noise and outliers; give {{any: [...]}}", key));
  }
  return {DrawnRange::Kind::kAnyOf, 0.0, 0.0, NamesOfChoice(key)};
}

void ReadRanges(const Place& place, const YAML::Node& node, const std::string& name, const Settings& with,
                std::vector<DrawnKey>* keys);

// A map: {log: ...}, {any: ...}, or the names of a choice, each with what is drawn in it.
void ReadMap(const Place& place, const YAML::Node& node, const std::string& key, const Settings& with,
             std::vector<DrawnKey>* keys) {
  const auto entries = Entries(place, node, key, {});
  DrawnKey drawn{key, with, {}};
  if (entries.size() == 1 && entries[0].first == kLog) {
    drawn.range = ReadEnds(place, entries[0].second, key, DrawnRange::Kind::kLogUniform);
    return keys->push_back(drawn);
  }
  if (entries.size() == 1 && entries[0].first == kAny) {
    drawn.range.words = Words(place, entries[0].second, key);
    return keys->push_back(drawn);
  }
  if (!IsChoice(key))
    place.Fail(node, fmt::format("{}: give [from, to], {{log: [from, to]}} or {{any: [...]}}", key));
  for (const auto& [word, inside] : entries) drawn.range.words.push_back(word);
  if (entries.empty()) place.Fail(node, fmt::format("{}: at least one name is needed", key));
  keys->push_back(drawn);
  for (const auto& [word, inside] : entries) {
    if (inside.IsNull()) continue;
    Settings deeper = with;
    deeper.emplace_back(key, word);
    if (deeper.size() > kMaxDepth) place.Fail(inside, fmt::format("{}: too many names within names", key));
    ReadRanges(place, inside, fmt::format("{}: {}", key, word), deeper, keys);
  }
}

void ReadRanges(const Place& place, const YAML::Node& node, const std::string& name, const Settings& with,
                std::vector<DrawnKey>* keys) {
  for (const auto& [key, value] : Entries(place, node, name, {})) {
    if (value.IsMap()) {
      ReadMap(place, value, key, with, keys);
    } else if (value.IsSequence()) {
      keys->push_back({key, with, ReadList(place, value, key)});
    } else {
      keys->push_back({key, with, ReadWord(place, value, key)});
    }
  }
}

Restriction ReadRestriction(const Place& place, const YAML::Node& node) {
  std::string text = Line(place, node, "given");
  std::erase(text, ' ');
  for (const char* comparison : kComparisons) {
    const size_t at = text.find(comparison);
    if (at == std::string::npos) continue;
    const Restriction restriction{text.substr(0, at), comparison,
                                  text.substr(at + std::string_view(comparison).size())};
    const bool is_whole = !restriction.left.empty() && !restriction.right.empty() &&
                          restriction.right.find_first_of("<>=") == std::string::npos;
    if (is_whole) return restriction;
    break;
  }
  place.Fail(node, fmt::format("given: {} is not allowed; give 'KEY < NUMBER', with <, <=, > or >=",
                               Quoted(Line(place, node, "given"))));
}

std::vector<Restriction> ReadGiven(const Place& place, const YAML::Node& node) {
  std::vector<Restriction> given;
  if (node.IsScalar()) return {ReadRestriction(place, node)};
  if (!node.IsSequence()) place.Fail(node, "given: a restriction or a list of them is needed");
  for (const YAML::Node& restriction : node) given.push_back(ReadRestriction(place, restriction));
  return given;
}

Settings ReadTexts(const Place& place, const YAML::Node& node, const std::string& name) {
  Settings texts;
  for (const auto& [key, text] : Entries(place, node, name, {}))
    texts.emplace_back(key, Scalar(place, text, key));
  return texts;
}

// `more` takes the place of the keys of that name, and what was drawn with them; new ones come last.
void PutInPlace(const std::vector<DrawnKey>& more, std::vector<DrawnKey>* keys) {
  const auto is_of = [](const DrawnKey& drawn, const std::string& key) {
    return drawn.with.empty() ? drawn.key == key : drawn.with.front().first == key;
  };
  for (auto begin = more.begin(); begin != more.end();) {
    const std::string& key = begin->key;
    const auto end = std::find_if_not(begin + 1, more.end(), [&](const DrawnKey& d) {
      return !d.with.empty() && d.with.front().first == key;
    });
    const auto first = std::ranges::find_if(*keys, [&](const DrawnKey& d) { return is_of(d, key); });
    const auto place = first - keys->begin();
    std::erase_if(*keys, [&](const DrawnKey& d) { return is_of(d, key); });
    keys->insert(keys->begin() + place, begin, end);
    begin = end;
  }
}

// What can be drawn: `data` with the first word of each choice, and that with each other word of one choice.
std::vector<Settings> PossibleSettings(const Study& study) {
  const Settings first = FirstSettingsOf(study);
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

// With each setting of `possible` that has the key: the ends of its range are allowed. Words become
// canonical.
void SettleKey(const std::vector<std::pair<Settings, Settings>>& possible, DrawnKey* drawn) {
  bool is_anywhere = false;
  for (const auto& [settings, resolved] : possible) {
    const bool has_key = std::ranges::count(resolved, drawn->key, &Settings::value_type::first) > 0;
    if (!has_key || !Has(resolved, drawn->with)) continue;
    is_anywhere = true;
    const auto canonical = [&, &settings = settings](const std::string& value) {
      Settings with_it = settings;
      with_it.emplace_back(drawn->key, value);
      const Settings written = ResolveSettings(with_it);
      return std::ranges::find(written, drawn->key, &Settings::value_type::first)->second;
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

void WriteRange(const DrawnRange& range, YAML::Emitter* out) {
  if (range.kind == DrawnRange::Kind::kUniform) {
    *out << YAML::Flow << YAML::BeginSeq << fmt::format("{}", range.from) << fmt::format("{}", range.to)
         << YAML::EndSeq;
    return;
  }
  if (range.kind == DrawnRange::Kind::kAnyOf && range.words.size() == 1) {
    *out << range.words.front();
    return;
  }
  *out << YAML::Flow << YAML::BeginMap;
  if (range.kind == DrawnRange::Kind::kLogUniform) {
    *out << YAML::Key << kLog << YAML::Value << YAML::BeginSeq << fmt::format("{}", range.from)
         << fmt::format("{}", range.to) << YAML::EndSeq;
  } else {
    *out << YAML::Key << kAny << YAML::Value << range.words;
  }
  *out << YAML::EndMap;
}

// The keys that are drawn with exactly `with`.
void WriteRanges(const std::vector<DrawnKey>& keys, const Settings& with, YAML::Emitter* out) {
  *out << YAML::BeginMap;
  for (const DrawnKey& drawn : keys) {
    if (drawn.with != with) continue;
    *out << YAML::Key << drawn.key << YAML::Value;
    const bool has_inside = std::ranges::any_of(keys, [&](const DrawnKey& d) {
      return d.with.size() > with.size() && std::equal(with.begin(), with.end(), d.with.begin()) &&
             d.with[with.size()].first == drawn.key;
    });
    if (!has_inside) {
      WriteRange(drawn.range, out);
      continue;
    }
    *out << YAML::BeginMap;
    for (const std::string& word : drawn.range.words) {  // each once: they are keys of a map
      Settings deeper = with;
      deeper.emplace_back(drawn.key, word);
      *out << YAML::Key << word << YAML::Value;
      WriteRanges(keys, deeper, out);
    }
    *out << YAML::EndMap;
  }
  *out << YAML::EndMap;
}

}  // namespace

Parameter PopulationDesignParameter(PointSet* design) {
  return Parameter::Choice<PointSet>(
      "design", design,
      {{"sobol", PointSet::kSobol},
       {"latin_hypercube", PointSet::kLatinHypercube},
       {"random", PointSet::kRandom}},
      "how draws fill the ranges; more draws leave the earlier ones of sobol and "
      "random as they are");
}

Parameter PopulationNumberParameter(int* number) {
  return Parameter::Integer("number", number, {1, kMaxDraws},
                            "draws; each that is not refused is a condition");
}

Population LoadPopulation(const std::string& name, PopulationText* text) {
  const std::string path = FindFile(name, SharedFolder::kPopulations, PopulationFileKind());
  const Place place(path);
  const YAML::Node root = ParseYaml(ReadInputText(path, PopulationFileKind()), path, PopulationFileKind());
  Population population;
  PopulationText unused;
  PopulationText& said = text == nullptr ? unused : *text;
  for (const auto& [key, node] : Entries(place, root, "population", StudyKeysOf("population"))) {
    if (key == "description") said.description = Scalar(place, node, key);
    if (key == "source") said.source = Scalar(place, node, key);
    if (key == "reasons") said.reasons = ReadTexts(place, node, key);
    if (key == "left_out") said.left_out = ReadTexts(place, node, key);
    if (key == "ranges") ReadRanges(place, node, key, {}, &population.keys);
    if (key == "given") population.given = ReadGiven(place, node);
  }
  if (population.keys.empty()) place.Fail(root, "population: key 'ranges' is missing");
  return population;
}

Population ReadPopulation(const Place& place, const YAML::Node& node) {
  Population population;
  const auto entries = Entries(place, node, "conditions", StudyKeysOf("conditions"));
  if (node["population"]) {
    const std::string name = Scalar(place, node["population"], "population");
    const std::filesystem::path path = std::filesystem::path(place.path()).parent_path() / name;
    place.At(node["population"],
             [&] { population = LoadPopulation(std::filesystem::exists(path) ? path.string() : name); });
  }
  for (const auto& [key, value] : entries) {
    place.At(value, [&, key = key, value = value] {
      if (key == "design")
        PopulationDesignParameter(&population.design).SetFromText(Scalar(place, value, key));
      if (key == "number")
        PopulationNumberParameter(&population.number).SetFromText(Scalar(place, value, key));
    });
    if (key == "ranges") {
      std::vector<DrawnKey> keys;
      ReadRanges(place, value, key, {}, &keys);
      PutInPlace(keys, &population.keys);
    }
    if (key == "draws") population.draws = ReadDraws(place, value);
    if (key == "given") {
      for (const Restriction& restriction : ReadGiven(place, value)) population.given.push_back(restriction);
    }
  }
  if (population.keys.empty()) place.Fail(node, "conditions: key 'ranges' or 'population' is missing");
  return population;
}

Settings FirstSettingsOf(const Study& study) {
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
  });
}

void WritePopulation(const Population& given, YAML::Emitter* out) {
  Population population = given;
  *out << YAML::BeginMap;
  *out << YAML::Key << "design" << YAML::Value << PopulationDesignParameter(&population.design).Value();
  *out << YAML::Key << "number" << YAML::Value << population.number;
  if (!population.draws.empty())
    *out << YAML::Key << "draws" << YAML::Value << YAML::Flow << population.draws;
  *out << YAML::Key << "ranges" << YAML::Value;
  WriteRanges(population.keys, {}, out);
  if (!population.given.empty()) {
    *out << YAML::Key << "given" << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const Restriction& restriction : population.given) *out << restriction.Text();
    *out << YAML::EndSeq;
  }
  *out << YAML::EndMap;
}

}  // namespace rcme
