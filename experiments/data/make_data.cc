#include "experiments/data/make_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "experiments/data/calibration_file.h"
#include "experiments/data/camera_noise.h"
#include "experiments/data/match_folder.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "parameters/settings.h"
#include "parameters/suggestion.h"
#include "simulator/camera_registry.h"
#include "simulator/motion_registry.h"
#include "simulator/noise_registry.h"
#include "simulator/outlier_registry.h"
#include "simulator/scene_registry.h"

namespace rcme {
namespace {

// `sigma_px`: null if the settings leave the noise level to the files.
std::vector<Parameter> Parameters(MatchFolderSettings& settings, double* sigma_px) {
  std::vector<Parameter> all = {Parameter::Text("folder", &settings.folder, "a folder of match files",
                                                "*.csv or *.csv.gz, seen from the study's folder")};
  if (sigma_px)
    all.push_back(Parameter::Real("sigma_px", sigma_px, {1e-9, 1000.0}, "px",
                                  "noise that the estimators assume, in place of the files' sigma_px"));
  const std::vector<Parameter> of_truth = {
      Parameter::Real("truth_rotation_sd_deg", &settings.truth.rotation_deg, {0.0, 90.0}, "deg",
                      "error of true poses about each axis, for files without truth_sd"),
      Parameter::Real("truth_position_sd", &settings.truth.position, {0.0, 1e6}, "",
                      "error of true positions along each axis, in the unit of the baselines")};
  all.insert(all.end(), of_truth.begin(), of_truth.end());
  const std::vector<Parameter> of_redraw = Parameters(settings.redraw);
  all.insert(all.end(), of_redraw.begin(), of_redraw.end());
  return all;
}

Parameter TruthInDoubtParameter(MatchFolderSettings& settings) {
  return Parameter::Text(kTruthInDoubtKey, &settings.truth_in_doubt,
                         "a CSV file with the columns scene and pair_id, seen from the study's folder",
                         "pairs not scored, as `rcme check-truth` doubts their truth");
}

// Adds the entries of a registry whose models have the parameter.
template <typename Entry>
void AddChoicesWith(const std::string& key, const std::string& choice, const std::vector<Entry>& registry,
                    std::vector<std::string>* choices) {
  std::vector<std::string> names;
  for (const Entry& entry : registry) {
    const auto model = entry.make();
    if (std::ranges::count(model->Parameters(), key, &Parameter::name) > 0) names.push_back(entry.name);
  }
  if (!names.empty()) choices->push_back(fmt::format("{}: {}", choice, fmt::join(names, " or ")));
}

// The keys that choose by name, with the field of each choice.
const std::vector<std::pair<std::string, std::string Choices::*>>& ChoiceKeys() {
  static const std::vector<std::pair<std::string, std::string Choices::*>> keys = {
      {"scene", &Choices::scene},
      {"cameras", &Choices::cameras},
      {"motion", &Choices::motion},
      {"noise", &Choices::noise},
      {"outliers", &Choices::outliers}};
  return keys;
}

Choices ChoicesIn(const Settings& settings) {
  Choices choices;
  for (const auto& [key, value] : settings) {
    for (const auto& [name, field] : ChoiceKeys()) {
      if (key != name) continue;
      if (value.empty()) {
        throw InputError(fmt::format("{}: '' is not allowed; give a name (see `rcme list`)", key));
      }
      choices.*field = value;
    }
  }
  if (choices.scene.empty())
    throw InputError("data: key 'scene' is missing; `rcme list scenes` lists the scenes");
  return choices;
}

[[noreturn]] void ThrowUnknownScene(const std::string& scene) {
  std::vector<std::string> names = {kMatchFilesScene};
  for (const SceneEntry& entry : SceneRegistry()) names.push_back(entry.name);
  throw InputError(fmt::format("scene: {} is not allowed{}; give one of: {}", Quoted(scene),
                               DidYouMean(scene, names), fmt::join(names, ", ")));
}

[[noreturn]] void ThrowUnknownKey(const std::string& key, const std::string& scene,
                                  const std::vector<Parameter>& parameters) {
  std::vector<std::string> names;
  for (const auto& [name, field] : ChoiceKeys()) names.push_back(name);
  if (scene == kMatchFilesScene) names.resize(1);
  for (const Parameter& parameter : parameters) names.push_back(parameter.name());
  for (const char* given : kGivenPairKeys) {
    if (scene == kMatchFilesScene && std::ranges::count(names, given) == 0) names.emplace_back(given);
  }
  const std::string needs = ChoicesWith(key);
  throw InputError(fmt::format("unknown key {} for scene {}{}; known keys: {}", Quoted(key), scene,
                               needs.empty() ? DidYouMean(key, names) : needs, fmt::join(names, ", ")));
}

// The parameters for the choices in the settings: of a folder of match files or of a simulation.
struct Configured {
  MatchFolderSettings folder;
  double sigma_px = kUsualSigmaPx;           // of a folder, if the settings state it
  std::shared_ptr<SimulatedData> simulated;  // null: a folder
  bool has_sigma = false;                    // the settings state sigma_px
  bool has_doubts = false;                   // the settings name a list of pairs in doubt

  explicit Configured(const Settings& given) {
    const Settings settings = WithNoiseFile(WithCalibration(given));
    const Choices choices = ChoicesIn(settings);
    has_sigma = FindSetting(settings, "sigma_px").has_value();
    has_doubts = FindSetting(settings, kTruthInDoubtKey).has_value();
    if (choices.scene != kMatchFilesScene) {
      const bool is_known = std::ranges::count(SceneRegistry(), choices.scene, &SceneEntry::name) > 0;
      if (!is_known) ThrowUnknownScene(choices.scene);
      simulated = std::make_shared<SimulatedData>(choices);
    }
    const std::vector<Parameter> parameters = AllParameters();
    for (const auto& [key, value] : settings) {
      if (key == "scene" || (simulated && IsChoice(key))) continue;
      const auto parameter = std::ranges::find(parameters, key, &Parameter::name);
      if (parameter == parameters.end()) ThrowUnknownKey(key, choices.scene, parameters);
      parameter->SetFromText(value);
    }
    if (has_sigma) folder.sigma_px = sigma_px;
  }

  std::vector<Parameter> AllParameters() {
    if (simulated) return simulated->Parameters();
    std::vector<Parameter> all = Parameters(folder, has_sigma ? &sigma_px : nullptr);
    if (has_doubts) all.push_back(TruthInDoubtParameter(folder));
    return all;
  }
  std::vector<Parameter> SceneParameters() {
    return simulated ? simulated->SceneParameters() : std::vector<Parameter>();
  }

  Settings ChosenNames() const {
    return simulated ? simulated->ChosenParts() : Settings{{"scene", kMatchFilesScene}};
  }
};

}  // namespace

std::string ChoicesWith(const std::string& key) {
  std::vector<std::string> choices;
  AddChoicesWith(key, "scene", SceneRegistry(), &choices);
  AddChoicesWith(key, "cameras", CameraRegistry(), &choices);
  AddChoicesWith(key, "motion", MotionRegistry(), &choices);
  AddChoicesWith(key, "noise", NoiseRegistry(), &choices);
  AddChoicesWith(key, "outliers", OutlierRegistry(), &choices);
  if (key == kCalibrationKey) choices.push_back(fmt::format("cameras: {}", kCamerasFromFile));
  if (key == kNoiseFileKey) choices.push_back(fmt::format("noise: {}", kNoiseFromFile));
  if (key == "folder" || key == kTruthInDoubtKey)
    choices.push_back(fmt::format("scene: {}", kMatchFilesScene));
  return choices.empty() ? "" : fmt::format(" (needs {})", fmt::join(choices, ", or "));
}

bool IsChoice(const std::string& key) {
  return std::ranges::any_of(ChoiceKeys(), [&](const auto& choice) { return choice.first == key; });
}

DataSources MakeDataSources(const Settings& settings, BaselineTiming search) {
  const Configured configured(settings);
  if (configured.simulated) {
    if (search == BaselineTiming::kNow) configured.simulated->FixBaseline();
    return {"", {{"", configured.simulated}}};
  }
  const std::string& folder = configured.folder.folder;
  if (!std::filesystem::is_directory(folder)) {
    throw InputError(
        fmt::format("folder: '{}' is not a folder, seen from {}; name yours, with *.csv or *.csv.gz match "
                    "files: --set folder=PAIRS",
                    folder, std::filesystem::current_path().string()));
  }
  return {"pair_scene", LoadMatchFolder(configured.folder)};
}

std::shared_ptr<const SimulatedData> MakeSimulatedData(const Settings& settings, BaselineTiming search) {
  const Configured configured(settings);
  if (!configured.simulated) throw InputError(fmt::format("scene: {} is not simulated", kMatchFilesScene));
  if (search == BaselineTiming::kNow) configured.simulated->FixBaseline();
  return configured.simulated;
}

Settings ResolveSettings(const Settings& settings) {
  Configured configured(settings);
  Settings resolved = configured.ChosenNames();
  const Settings values = ListValues(configured.AllParameters());
  resolved.insert(resolved.end(), values.begin(), values.end());
  return resolved;
}

Settings DistinctiveSettings(const Settings& settings, bool of_scene) {
  static const std::set<std::string> kWithoutEffect = {"folder", kTruthInDoubtKey, "severity"},
                                     kNotOfTheScene = {"noise", "outliers"};
  Configured configured(settings);
  Settings distinctive = configured.ChosenNames();
  Configured defaults(distinctive);
  defaults.has_sigma = configured.has_sigma;
  defaults.has_doubts = configured.has_doubts;
  if (of_scene)
    std::erase_if(distinctive, [](const auto& choice) { return kNotOfTheScene.contains(choice.first); });
  const auto parameters = of_scene ? configured.SceneParameters() : configured.AllParameters();
  const auto at_default = of_scene ? defaults.SceneParameters() : defaults.AllParameters();
  for (size_t i = 0; i < parameters.size(); ++i) {
    const std::string &name = parameters[i].name(), value = parameters[i].Value();
    if (value == at_default[i].Value() || kWithoutEffect.contains(name)) continue;
    distinctive.emplace_back(name, value);
  }
  return distinctive;
}

std::vector<SettingHelp> DescribeSettings(const Settings& settings) {
  Configured configured(settings);
  configured.has_sigma = configured.has_doubts = true;
  std::vector<SettingHelp> help;
  for (const Parameter& p : configured.AllParameters()) {
    help.push_back({p.name(), p.Value(), p.unit(), p.allowed(), p.doc()});
  }
  return help;
}

}  // namespace rcme
