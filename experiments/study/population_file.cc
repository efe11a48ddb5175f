#include "experiments/study/population_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "experiments/core/files/shared_files.h"
#include "experiments/study/drawn_range_file.h"
#include "experiments/study/study_keys.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

constexpr const char* kComparisons[] = {"<=", ">=", "<", ">"};
const FileKind& PopulationFileKind() {
  static const FileKind kind = {"population file", "a population of conditions"};
  return kind;
}

// Reads numbers of draws, ascending and each once.
std::vector<int> ReadDraws(const Place& place, const YAML::Node& node) {
  std::vector<int> draws;
  for (const std::string& word : ReadWords(place, node, "draws")) {
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

// Merges ranges: those in `more` replace keys of the same name and what was drawn with them; new keys come
// last.
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

}  // namespace

Parameter PopulationDesignParameter(PointSet* design) {
  return Parameter::Choice<PointSet>(
      "design", design,
      {{"sobol", PointSet::kSobol},
       {"latin_hypercube", PointSet::kLatinHypercube},
       {"random", PointSet::kRandom}},
      "how draws fill the ranges; sobol and random keep earlier draws when number grows");
}

Parameter PopulationNumberParameter(int* number) {
  return Parameter::Integer("number", number, {1, kMaxDraws}, "draws; each one not refused is a condition");
}

Population LoadPopulation(const std::string& name, PopulationText* text) {
  const std::string path = FindFile(name, SharedFolder::kPopulations, PopulationFileKind());
  const Place place(path);
  const YAML::Node root = ParseYaml(ReadInputText(path, PopulationFileKind()), path, PopulationFileKind());
  Population population;
  PopulationText unused;
  PopulationText& said = text == nullptr ? unused : *text;
  for (const auto& [key, node] : Entries(place, root, "population", ListStudyKeys("population"))) {
    if (key == "description") said.description = Scalar(place, node, key);
    if (key == "source") said.source = Scalar(place, node, key);
    if (key == "reasons") said.reasons = ReadTexts(place, node, key);
    if (key == "left_out") said.left_out = ReadTexts(place, node, key);
    if (key == "ranges") population.keys = ReadRanges(place, node, key);
    if (key == "given") population.given = ReadGiven(place, node);
  }
  if (population.keys.empty()) place.Fail(root, "population: key 'ranges' is missing");
  return population;
}

Population ReadPopulation(const Place& place, const YAML::Node& node) {
  Population population;
  const auto entries = Entries(place, node, "conditions", ListStudyKeys("conditions"));
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
    if (key == "ranges") PutInPlace(ReadRanges(place, value, key), &population.keys);
    if (key == "draws") population.draws = ReadDraws(place, value);
    if (key == "given") {
      for (const Restriction& restriction : ReadGiven(place, value)) population.given.push_back(restriction);
    }
  }
  if (population.keys.empty()) place.Fail(node, "conditions: key 'ranges' or 'population' is missing");
  return population;
}

void WritePopulation(const Population& given, YAML::Emitter* out) {
  Population population = given;
  *out << YAML::BeginMap;
  *out << YAML::Key << "design" << YAML::Value << PopulationDesignParameter(&population.design).Value();
  *out << YAML::Key << "number" << YAML::Value << population.number;
  if (!population.draws.empty())
    *out << YAML::Key << "draws" << YAML::Value << YAML::Flow << population.draws;
  *out << YAML::Key << "ranges" << YAML::Value;
  WriteRanges(population.keys, out);
  if (!population.given.empty()) {
    *out << YAML::Key << "given" << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const Restriction& restriction : population.given) *out << restriction.Text();
    *out << YAML::EndSeq;
  }
  *out << YAML::EndMap;
}

}  // namespace rcme
