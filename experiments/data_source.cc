#include "experiments/data_source.h"

#include <fmt/format.h>

#include "experiments/real_data/match_folder.h"
#include "experiments/simulated_data.h"
#include "parameters/input_error.h"
#include "simulator/scene_registry.h"

namespace rcme {
namespace {

std::vector<Parameter> Parameters(MatchFolderSettings& settings) {
  return {Parameter::Text("folder", &settings.folder, "a folder of match files",
                          "folder with *.csv or *.csv.gz, relative to the working directory"),
          Parameter::Real("sigma_px", &settings.sigma_px, {1e-9, 1000.0}, "px",
                          "noise standard deviation that the estimators are told")};
}

std::string SceneNameIn(const Settings& settings) {
  std::string scene;
  for (const auto& [key, value] : settings) {
    if (key == "scene") scene = value;
  }
  if (scene.empty()) throw InputError("data: key 'scene' is missing; `rcme list scenes` shows what there is");
  return scene;
}

[[noreturn]] void ThrowUnknownScene(const std::string& scene) {
  std::vector<std::string> names = {kMatchFilesScene};
  for (const SceneEntry& entry : SceneRegistry()) names.push_back(entry.name);
  throw InputError(fmt::format("scene: '{}' is not allowed; give one of: {}", scene, fmt::join(names, ", ")));
}

// The scene's parameters: of a folder of match files, or of a simulation.
struct Configured {
  MatchFolderSettings folder;
  std::shared_ptr<SimulatedData> simulated;  // null: a folder

  explicit Configured(const std::string& scene) {
    if (scene == kMatchFilesScene) return;
    const SceneEntry* entry = FindScene(scene);
    if (!entry) ThrowUnknownScene(scene);
    simulated = std::make_shared<SimulatedData>(entry->make());
  }
  std::vector<Parameter> AllParameters() { return simulated ? simulated->Parameters() : Parameters(folder); }

  void Apply(const Settings& settings) {
    const std::vector<Parameter> parameters = AllParameters();
    for (const auto& [key, value] : settings) {
      if (key != "scene") FindParameter(parameters, key).SetFromText(value);
    }
  }
};

}  // namespace

RandomStream StreamFor(StreamName trial_name, StreamPurpose purpose) {
  trial_name.purpose = static_cast<std::uint32_t>(purpose);
  return RandomStream(trial_name);
}

DataSources MakeDataSources(const Settings& settings) {
  Configured configured(SceneNameIn(settings));
  configured.Apply(settings);
  if (configured.simulated) return {"", {{"", configured.simulated}}};
  return {"pair_scene", LoadMatchFolder(configured.folder)};
}

std::shared_ptr<const SimulatedData> MakeSimulatedData(const Settings& settings) {
  Configured configured(SceneNameIn(settings));
  configured.Apply(settings);
  if (!configured.simulated) throw InputError(fmt::format("scene: {} is not simulated", kMatchFilesScene));
  return configured.simulated;
}

Settings ResolveSettings(const Settings& settings) {
  const std::string scene = SceneNameIn(settings);
  Configured configured(scene);
  configured.Apply(settings);
  Settings resolved = {{"scene", scene}};
  for (const Parameter& parameter : configured.AllParameters()) {
    resolved.emplace_back(parameter.name(), parameter.Value());
  }
  return resolved;
}

std::vector<SettingHelp> DescribeSettings(const std::string& scene) {
  Configured configured(scene);
  std::vector<SettingHelp> help;
  for (const Parameter& p : configured.AllParameters()) {
    help.push_back({p.name(), p.Value(), p.unit(), p.allowed(), p.doc()});
  }
  return help;
}

}  // namespace rcme
