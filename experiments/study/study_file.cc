#include "experiments/study/study_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "experiments/core/files/shared_files.h"
#include "experiments/core/text/shell_word.h"
#include "experiments/data/calibration_file.h"
#include "experiments/data/camera_noise.h"
#include "experiments/data/make_data.h"
#include "experiments/data/match_rows.h"
#include "experiments/study/command_permission.h"
#include "experiments/study/estimator_entry.h"
#include "experiments/study/estimator_file.h"
#include "experiments/study/population_file.h"
#include "experiments/study/settle_study.h"
#include "experiments/study/study_keys.h"
#include "experiments/study/tuning_file.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "parameters/settings.h"
#include "parameters/suggestion.h"

namespace rcme {
namespace {

constexpr int kMaxTrials = 2'000'000'000;

const FileKind& StudyFileKind() {
  static const FileKind kind = {"study file", "a study"};
  return kind;
}

long long WholeNumber(const Place& place, const YAML::Node& node, const std::string& key, long long min,
                      long long max) {
  const std::string text = Scalar(place, node, key);
  long long value = 0;
  if (!ParseInteger(text, &value) || value < min || value > max) {
    place.Fail(node, fmt::format("{}: {} is not allowed; give a whole number in [{}, {}]", key, Quoted(text),
                                 min, max));
  }
  return value;
}

void ReadFactors(const Place& place, const YAML::Node& node, Study* study) {
  for (const auto& [key, levels] : Entries(place, node, "factors", {})) {
    Factor factor{key, {}};
    if (!levels.IsSequence() || levels.size() == 0) {
      place.Fail(levels, fmt::format("factors: {}: a list of at least one level is needed", key));
    }
    for (const YAML::Node& level : levels) factor.levels.push_back(Line(place, level, key));
    study->factors.push_back(std::move(factor));
  }
}

Parameter DesignParameter(Design* design) {
  return Parameter::Choice<Design>(
      "design", design, {{"full_factorial", Design::kFullFactorial}, {"one_at_a_time", Design::kOneAtATime}},
      "which combinations of the factors' levels are run");
}

Parameter CommonScenesParameter(bool* common_scenes) {
  return Parameter::Choice<bool>("common_scenes", common_scenes, {{"true", true}, {"false", false}},
                                 "the same scenes in all conditions whose scene is shaped alike");
}

// Reads an entry of the list of estimators. {file: tuned.yaml} names an estimator file, relative to the
// study's folder.
EstimatorSpec ReadEstimator(const Place& place, const YAML::Node& node) {
  if (node.IsScalar()) {
    const std::string name = Scalar(place, node, "estimators");
    place.At(node, [&] { RequireEstimatorName(name); });
    place.Fail(node, fmt::format("estimators: {} is no map of keys and values; write {{name: {}}}",
                                 Quoted(name), name));
  }
  if (!node.IsMap() || !node["file"])
    return ReadEstimatorEntry(place, node, "estimators", ListStudyKeys("estimators"));
  EstimatorSpec spec;
  std::string label;
  for (const auto& [key, value] : Entries(place, node, "estimators: file", {"file", "label"})) {
    const std::string text = Scalar(place, value, key);
    if (key == "label") label = ReadLabel(place, value);
    if (key != "file") continue;
    const std::filesystem::path path = std::filesystem::path(place.path()).parent_path() / text;
    place.At(value, [&] { spec = LoadEstimatorFile(std::filesystem::exists(path) ? path.string() : text); });
  }
  if (!label.empty()) spec.label = label;
  return spec;
}

void ReadEstimators(const Place& place, const YAML::Node& node, Study* study) {
  if (!node.IsSequence() || node.size() == 0) {
    place.Fail(node, "estimators: a list of at least one estimator is needed");
  }
  if (node.size() > kMaxEstimators)
    place.Fail(node, fmt::format("estimators: {} are too many; at most {} are allowed", node.size(),
                                 kMaxEstimators));
  for (const YAML::Node& entry : node) {
    EstimatorSpec spec = ReadEstimator(place, entry);
    for (const EstimatorSpec& other : study->estimators) {
      if (other.label == spec.label) {
        place.Fail(entry,
                   fmt::format("estimators: label '{}' stands twice; give each estimator its own label",
                               spec.label));
      }
    }
    study->estimators.push_back(std::move(spec));
  }
}

// The names that hypotheses may refer to; call this after the levels of the factors are canonical.
StatableNames ListStatableNames(const Study& study) {
  StatableNames names;
  names.estimators = ListLabels(study.estimators);
  for (const Factor& factor : study.factors) names.factors.emplace_back(factor.key, factor.levels);
  return names;
}

Ademp ReadAdemp(const Place& place, const YAML::Node& node) {
  Ademp ademp;
  const auto entries = Entries(place, node, "ademp", ListStudyKeys("ademp"));
  for (const auto& [key, text] : Parts(ademp)) {
    const auto entry = std::ranges::find(entries, key, &std::pair<std::string, YAML::Node>::first);
    if (entry == entries.end()) place.Fail(node, fmt::format("ademp: key '{}' is missing", key));
    *text = Scalar(place, entry->second, key);
  }
  return ademp;
}

Design ReadDesign(const Place& place, const YAML::Node& node) {
  Design design = Design::kFullFactorial;
  place.At(node, [&] { DesignParameter(&design).SetFromText(Scalar(place, node, "design")); });
  return design;
}

// Returns every data parameter with its value. If a factor chooses a part of the simulation, the parameters
// differ between conditions; then only the given ones are returned.
Settings WrittenData(const Study& study) {
  const bool has_choice = study.population || std::ranges::any_of(study.factors, IsChoice, &Factor::key);
  return has_choice ? study.data : ResolveSettings(study.data);
}

std::vector<std::string> DataKeys(const Study& study) {
  std::vector<std::string> keys;
  const Settings settings = ResolveSettings(ChooseFirstSettings(study));
  for (const auto& [key, value] : settings) keys.push_back(key);
  if (FindSetting(settings, "scene") != kMatchFilesScene) return keys;
  for (const char* given : kGivenPairKeys) {
    if (std::ranges::count(keys, given) == 0) keys.emplace_back(given);
  }
  return keys;
}

std::vector<std::string> BoundKeys() {
  FailureBounds bounds;
  std::vector<std::string> keys;
  for (const Parameter& bound : Parameters(bounds)) keys.push_back(bound.name());
  return keys;
}

bool IsIn(const std::vector<std::string>& keys, const std::string& key) {
  return std::ranges::count(keys, key) > 0;
}

void OverrideOption(const std::string& option, const std::string& value, EstimatorSpec* spec) {
  SetOwnOptions(spec, {{option, value}});
  Configure(*spec)->Make();  // throws if options contradict each other
}

// Applies `--set conditions.number=512`, or fixes a drawn key at one value.
void OverridePopulation(const std::string& key, const std::string& value, Population* population) {
  FindParameter(
      {PopulationDesignParameter(&population->design), PopulationNumberParameter(&population->number)}, key)
      .SetFromText(value);
}

void OverrideData(const std::string& key, const std::string& value, Study* study) {
  const std::string canonical = MakeCanonical(ChooseFirstSettings(*study), key, value);
  std::erase_if(study->data, [&](const auto& setting) { return setting.first == key; });
  study->data.emplace_back(key, canonical);
  std::erase_if(study->factors, [&](const Factor& factor) { return factor.key == key; });
  if (!study->population) return;
  std::erase_if(study->population->keys, [&](const DrawnKey& drawn) {
    return drawn.key == key || std::ranges::any_of(drawn.with, [&](const auto& choice) {
             return choice.first == key && choice.second != canonical;
           });
  });
}

EstimatorSpec& LabelledEstimator(const std::string& label, Study* study) {
  const auto spec = std::ranges::find(study->estimators, label, &EstimatorSpec::label);
  if (spec != study->estimators.end()) return *spec;
  const std::vector<std::string> labels = ListLabels(study->estimators);
  throw InputError(fmt::format("--set: the study has no estimator {}{}; its estimators: {}", Quoted(label),
                               DidYouMean(label, labels), fmt::join(labels, ", ")));
}

[[noreturn]] void ThrowUnknownOverride(const Study& study, const std::string& key) {
  std::vector<std::string> options;
  for (const EstimatorSpec& spec : study.estimators) {
    for (const auto& [option, value] : spec.options) {
      if (!IsIn(options, option)) options.push_back(option);
    }
  }
  std::vector<std::string> all = options;
  for (const std::vector<std::string>& keys : {DataKeys(study), BoundKeys()})
    all.insert(all.end(), keys.begin(), keys.end());
  const std::string needs = ChoicesWith(key);
  throw InputError(fmt::format(
      "--set: unknown key {}{}; known keys: of the data: {}; failure bounds: {}; options "
      "of the estimators: {}",
      Quoted(key), needs.empty() ? DidYouMean(key, all) : needs, fmt::join(DataKeys(study), ", "),
      fmt::join(BoundKeys(), ", "), options.empty() ? "none" : fmt::format("{}", fmt::join(options, ", "))));
}

// Sets the option of an estimator that has the name of a failure bound of the study.
void FollowBound(const Place& place, const YAML::Node& root, const Parameter& bound, EstimatorSpec* spec) {
  try {
    SetOptions(spec, {{bound.name(), bound.Value()}});
  } catch (const InputError& error) {
    place.Fail(root["failure"][bound.name()],
               fmt::format("failure: the estimator {} takes this bound for its option of that name: {}",
                           Quoted(spec->label), error.what()));
  }
}

// Estimators that state a failure probability have failure bounds of their own. They get those of the study
// unless their entry gives others. Estimator files keep theirs.
void FollowFailureBounds(const Place& place, const YAML::Node& root, Study* study) {
  const YAML::Node entries = root["estimators"];
  for (size_t i = 0; i < study->estimators.size(); ++i) {
    EstimatorSpec& spec = study->estimators[i];
    if (!entries[i].IsMap() || entries[i]["file"]) continue;
    for (const Parameter& bound : Parameters(study->failure)) {
      const bool is_given = entries[i]["options"] && entries[i]["options"][bound.name()];
      if (!is_given && FindSetting(spec.options, bound.name())) FollowBound(place, root, bound, &spec);
    }
  }
}

// Throws InputError for a factor that replaces a value in `data`, which would have no effect. A one-at-a-time
// design takes its base values from there. Defaults are allowed, because ToYaml writes them.
void RefuseReplacedData(const Place& place, const YAML::Node& root, const Study& study) {
  if (study.design == Design::kOneAtATime || !root["data"] || !root["factors"]) return;
  const Settings first = ChooseFirstSettings(study);
  for (const Factor& factor : study.factors) {
    const YAML::Node given = root["data"][factor.key];
    if (!given) continue;
    Settings others = first;
    std::erase_if(others, [&](const auto& setting) { return setting.first == factor.key; });
    const bool is_default = !IsChoice(factor.key) && FindSetting(ResolveSettings(others), factor.key) ==
                                                         FindSetting(study.data, factor.key);
    if (is_default) continue;
    place.Fail(
        root["factors"][factor.key],
        fmt::format("factors: {0} is also in data ({1}), where {2} would have no effect; leave one out",
                    factor.key, place.Text(given), Quoted(given.Scalar())));
  }
}

// The settings whose values are paths.
constexpr const char* kPathKeys[] = {"folder", kCalibrationKey, kNoiseFileKey, kTruthInDoubtKey};

// Makes a path in a study relative to the study's folder.
std::string SeenFrom(const std::filesystem::path& folder, const std::string& path) {
  if (folder.empty() || path.empty() || std::filesystem::path(path).is_absolute()) return path;
  return (folder / path).lexically_normal().string();
}

void SeePathsFrom(const std::filesystem::path& folder, Study* study) {
  const auto is_path = [](const std::string& key) { return std::ranges::count(kPathKeys, key) > 0; };
  for (auto& [key, value] : study->data) {
    if (is_path(key)) value = SeenFrom(folder, value);
  }
  for (Factor& factor : study->factors) {
    for (std::string& level : factor.levels) {
      if (is_path(factor.key)) level = SeenFrom(folder, level);
    }
  }
}

// Who wrote the text of a study.
enum class Author { kPerson, kProgram };

// `folder`: the paths in the data are relative to it.
Study ReadStudy(const std::string& yaml, const std::string& path, const std::filesystem::path& folder,
                Author author) {
  const Place place(path);
  const YAML::Node root = ParseYaml(yaml, path, StudyFileKind());
  Study study;
  study.name = std::filesystem::path(path).stem().string();
  for (const auto& [key, node] : Entries(place, root, "study", ListStudyKeys("study"))) {
    if (key == "name") study.name = Name(place, node, key);
    if (key == "description") study.description = Scalar(place, node, key);
    if (key == "seed") {
      study.seed =
          static_cast<std::uint64_t>(WholeNumber(place, node, key, 0, std::numeric_limits<long long>::max()));
    }
    if (key == "trials") study.trials = static_cast<int>(WholeNumber(place, node, key, 1, kMaxTrials));
    if (key == "repeats_per_scene")
      study.repeats_per_scene = static_cast<int>(WholeNumber(place, node, key, 1, kMaxRepeatsPerScene));
    if (key == "data") {
      for (const auto& [setting, value] : Entries(place, node, "data", {})) {
        study.data.emplace_back(setting, Line(place, value, setting));
      }
    }
    if (key == "common_scenes") {
      place.At(node, [&, node = node] {
        CommonScenesParameter(&study.common_scenes).SetFromText(Scalar(place, node, "common_scenes"));
      });
    }
    if (key == "ademp") study.ademp = ReadAdemp(place, node);
    if (key == "design") study.design = ReadDesign(place, node);
    if (key == "factors") ReadFactors(place, node, &study);
    if (key == "conditions") study.population = ReadPopulation(place, node);
    if (key == "estimators") ReadEstimators(place, node, &study);
    if (key == "failure") {
      for (const auto& [bound, value] : Entries(place, node, "failure", {})) {
        place.At(value, [&, bound = bound, value = value] {
          FindParameter(Parameters(study.failure), bound).SetFromText(Scalar(place, value, bound));
        });
      }
    }
  }
  if (!root["data"] && !root["conditions"]) place.Fail(root, "study: key 'data' is missing");
  if (study.estimators.empty()) place.Fail(root, "study: key 'estimators' is missing");
  SeePathsFrom(folder, &study);
  place.At(root["data"] ? root["data"] : root,
           [&] { study.data = WithNoiseFile(WithCalibration(study.data)); });
  FollowFailureBounds(place, root, &study);
  SettleData(place, root, &study);
  if (author == Author::kPerson) RefuseReplacedData(place, root, study);
  if (root["hypotheses"])
    study.hypotheses = ReadHypotheses(place, root["hypotheses"], ListStatableNames(study));
  if (root["tune"]) study.tuning = ReadTuning(place, root["tune"], study.estimators);
  return study;
}

}  // namespace

Study LoadStudy(const std::string& name) {
  const std::string path = FindFile(name, SharedFolder::kStudies, StudyFileKind());
  const std::string text = ReadInputText(path, StudyFileKind());
  if (IsMatchText(text)) {
    throw InputError(fmt::format("{}: is a match file, not a study; `rcme estimate {}` estimates its motion",
                                 path, QuoteForShell(path)));
  }
  return ReadStudy(text, path, std::filesystem::path(path).parent_path(), Author::kPerson);
}

Study ParseStudy(const std::string& yaml, const std::string& path) {
  return ReadStudy(yaml, path, {}, Author::kProgram);
}

void Override(Study* study, const std::string& key, const std::string& value) {
  const size_t dot = key.rfind('.');
  if (study->population && key.starts_with("conditions."))
    return OverridePopulation(key.substr(dot + 1), value, &*study->population);
  if (dot != std::string::npos) {
    std::erase_if(study->factors, [&](const Factor& factor) { return factor.key == key; });
    return OverrideOption(key.substr(dot + 1), value, &LabelledEstimator(key.substr(0, dot), study));
  }
  if (IsIn(DataKeys(*study), key)) return OverrideData(key, value, study);
  bool has_any = IsIn(BoundKeys(), key);
  if (has_any) FindParameter(Parameters(study->failure), key).SetFromText(value);
  for (EstimatorSpec& spec : study->estimators) {
    if (!FindSetting(spec.options, key)) continue;
    try {
      OverrideOption(key, value, &spec);
    } catch (const InputError& error) {
      double number = 0.0;
      if (key != "sigma" || !ParseReal(value, &number)) throw;
      throw InputError(fmt::format("{} (the noise is sigma_px)", error.what()));
    }
    has_any = true;
  }
  if (!has_any) ThrowUnknownOverride(*study, key);
}

Study WithAbsolutePaths(Study study) {
  SeePathsFrom(std::filesystem::current_path(), &study);
  return study;
}

std::string ToYaml(const Study& study) {
  YAML::Emitter out;
  out.SetSeqFormat(YAML::Flow);
  out << YAML::BeginMap;
  out << YAML::Key << "name" << YAML::Value << study.name;
  out << YAML::Key << "description" << YAML::Value << study.description;
  if (study.ademp) {
    Ademp ademp = *study.ademp;
    out << YAML::Key << "ademp" << YAML::Value << YAML::BeginMap;
    for (const auto& [key, text] : Parts(ademp)) out << YAML::Key << key << YAML::Value << *text;
    out << YAML::EndMap;
  }
  out << YAML::Key << "seed" << YAML::Value << study.seed;
  out << YAML::Key << "trials" << YAML::Value << study.trials;
  if (study.repeats_per_scene > 1)
    out << YAML::Key << "repeats_per_scene" << YAML::Value << study.repeats_per_scene;
  if (study.common_scenes) out << YAML::Key << "common_scenes" << YAML::Value << true;
  out << YAML::Key << "data" << YAML::Value << YAML::BeginMap;
  for (const auto& [key, value] : WrittenData(study)) out << YAML::Key << key << YAML::Value << value;
  out << YAML::EndMap;
  if (study.design != Design::kFullFactorial) {
    Design design = study.design;
    out << YAML::Key << "design" << YAML::Value << DesignParameter(&design).Value();
  }
  if (study.population) {
    out << YAML::Key << "conditions" << YAML::Value;
    WritePopulation(*study.population, &out);
  }
  if (!study.factors.empty()) {
    out << YAML::Key << "factors" << YAML::Value << YAML::BeginMap;
    for (const Factor& factor : study.factors) out << YAML::Key << factor.key << YAML::Value << factor.levels;
    out << YAML::EndMap;
  }
  out << YAML::Key << "estimators" << YAML::Value << YAML::Block << YAML::BeginSeq;
  for (const EstimatorSpec& spec : study.estimators) {
    out << YAML::BeginMap;
    WriteEstimatorKeys(spec, &out);
    out << YAML::EndMap;
  }
  out << YAML::EndSeq;
  FailureBounds bounds = study.failure;
  out << YAML::Key << "failure" << YAML::Value << YAML::BeginMap;
  for (const Parameter& p : Parameters(bounds)) out << YAML::Key << p.name() << YAML::Value << p.Value();
  out << YAML::EndMap;
  if (!study.hypotheses.empty()) {
    out << YAML::Key << "hypotheses" << YAML::Value;
    WriteHypotheses(study.hypotheses, &out);
  }
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

}  // namespace rcme
