#include "experiments/study/drawn_range_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "experiments/data/make_data.h"
#include "parameters/parameter.h"
#include "parameters/plain_text.h"
#include "parameters/suggestion.h"
#include "simulator/camera_registry.h"
#include "simulator/motion_registry.h"
#include "simulator/noise_registry.h"
#include "simulator/outlier_registry.h"
#include "simulator/scene_registry.h"

namespace rcme {
namespace {

constexpr const char *kAny = "any", *kLog = "log", *kAnyOf = "any of ", *kLogOf = "log ";
constexpr size_t kMaxDepth = 4;  // nesting of words with ranges of their own

// The names that a choice of the data allows.
std::vector<std::string> NamesOfChoice(const std::string& key) {
  if (key == "scene") return ListNames(SceneRegistry());
  if (key == "cameras") return ListNames(CameraRegistry());
  if (key == "motion") return ListNames(MotionRegistry());
  if (key == "noise") return ListNames(NoiseRegistry());
  return ListNames(OutlierRegistry());
}

bool IsNumber(const YAML::Node& node) {
  double value = 0.0;
  return node.IsScalar() && ParseReal(node.Scalar(), &value);
}

// Reads two numbers, the first less than the second.
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
  if (!has_number) return {DrawnRange::Kind::kAnyOf, 0.0, 0.0, ReadWords(place, node, key)};
  if (node.size() != 2 || !IsNumber(node[0]) || !IsNumber(node[1])) {
    place.Fail(node, fmt::format(
                         "{}: a range has two numbers, [from, to]; of single ones give {{any: [...]}}", key));
  }
  return ReadEnds(place, node, key, DrawnRange::Kind::kUniform);
}

// Parses "log [0.1, 3]", "any of [a, b]", "any", or a fixed value.
DrawnRange ReadWord(const Place& place, const YAML::Node& node, const std::string& key) {
  const std::string text = Line(place, node, key);
  const auto rest = [&](const char* beginning) {
    try {
      return YAML::Load(text.substr(std::string_view(beginning).size()));
    } catch (const YAML::Exception&) {
      place.Fail(node, fmt::format("{}: {} is not allowed; give {}[..., ...]", key, Quoted(text), beginning));
    }
  };
  const Place here = place.FixLineTo(node);
  if (text.starts_with(kLogOf)) return ReadEnds(here, rest(kLogOf), key, DrawnRange::Kind::kLogUniform);
  if (text.starts_with(kAnyOf))
    return {DrawnRange::Kind::kAnyOf, 0.0, 0.0, ReadWords(here, rest(kAnyOf), key)};
  if (text != kAny) return {DrawnRange::Kind::kAnyOf, 0.0, 0.0, {text}};
  if (!IsChoice(key)) {
    place.Fail(
        node,
        fmt::format("{}: any is for scene, cameras, motion, noise and outliers; give {{any: [...]}}", key));
  }
  return {DrawnRange::Kind::kAnyOf, 0.0, 0.0, NamesOfChoice(key)};
}

void AddRanges(const Place& place, const YAML::Node& node, const std::string& name, const Settings& with,
               std::vector<DrawnKey>* keys);

// Reads a map: {log: ...}, {any: ...}, or the names of a choice, each with the keys that are drawn with it.
void ReadMap(const Place& place, const YAML::Node& node, DrawnKey drawn, std::vector<DrawnKey>* keys) {
  const std::string key = drawn.key;
  const auto entries = Entries(place, node, key, {});
  if (entries.size() == 1 && entries[0].first == kLog) {
    drawn.range = ReadEnds(place, entries[0].second, key, DrawnRange::Kind::kLogUniform);
    return keys->push_back(drawn);
  }
  if (entries.size() == 1 && entries[0].first == kAny) {
    drawn.range.words = ReadWords(place, entries[0].second, key);
    return keys->push_back(drawn);
  }
  if (!IsChoice(key))
    place.Fail(node, fmt::format("{}: give [from, to], {{log: [from, to]}} or {{any: [...]}}", key));
  for (const auto& [word, inside] : entries) drawn.range.words.push_back(word);
  if (entries.empty()) place.Fail(node, fmt::format("{}: at least one name is needed", key));
  keys->push_back(drawn);
  for (const auto& [word, inside] : entries) {
    if (inside.IsNull()) continue;
    Settings deeper = drawn.with;
    deeper.emplace_back(key, word);
    if (deeper.size() > kMaxDepth) place.Fail(inside, fmt::format("{}: too many names within names", key));
    AddRanges(place, inside, fmt::format("{}: {}", key, word), deeper, keys);
  }
}

void AddRanges(const Place& place, const YAML::Node& node, const std::string& name, const Settings& with,
               std::vector<DrawnKey>* keys) {
  const auto entries = Entries(place, node, name, {});
  std::map<std::string, std::string> places;
  for (const auto& entry : node) places[entry.first.Scalar()] = place.Text(entry.first);
  for (const auto& [key, value] : entries) {
    DrawnKey drawn{key, with, {}, places.at(key)};
    if (value.IsMap()) {
      ReadMap(place, value, drawn, keys);
      continue;
    }
    drawn.range = value.IsSequence() ? ReadList(place, value, key) : ReadWord(place, value, key);
    keys->push_back(std::move(drawn));
  }
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

// Writes the keys that are drawn with exactly `with`.
void WriteRangesWith(const std::vector<DrawnKey>& keys, const Settings& with, YAML::Emitter* out) {
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
    for (const std::string& word : drawn.range.words) {  // each word once: they are keys of a map
      Settings deeper = with;
      deeper.emplace_back(drawn.key, word);
      *out << YAML::Key << word << YAML::Value;
      WriteRangesWith(keys, deeper, out);
    }
    *out << YAML::EndMap;
  }
  *out << YAML::EndMap;
}

}  // namespace

std::vector<std::string> ReadWords(const Place& place, const YAML::Node& node, const std::string& key) {
  if (!node.IsSequence() || node.size() == 0)
    place.Fail(node, fmt::format("{}: a list of at least one word or number is needed", key));
  std::vector<std::string> words;
  for (const YAML::Node& word : node) words.push_back(Line(place, word, key));
  return words;
}

std::vector<DrawnKey> ReadRanges(const Place& place, const YAML::Node& node, const std::string& name) {
  std::vector<DrawnKey> keys;
  AddRanges(place, node, name, {}, &keys);
  return keys;
}

void WriteRanges(const std::vector<DrawnKey>& keys, YAML::Emitter* out) { WriteRangesWith(keys, {}, out); }

}  // namespace rcme
