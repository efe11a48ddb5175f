#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "estimator/estimator_registry.h"
#include "experiments/audit/claims/claim_table.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/core/files/shared_files.h"
#include "experiments/core/files/yaml_input.h"
#include "experiments/core/text/columns.h"
#include "experiments/core/text/json_output.h"
#include "experiments/data/calibration_file.h"
#include "experiments/data/make_data.h"
#include "experiments/statistics/summarize.h"
#include "experiments/study/estimator_entry.h"
#include "experiments/study/study_keys.h"
#include "parameters/suggestion.h"
#include "simulator/camera_registry.h"
#include "simulator/motion_registry.h"
#include "simulator/noise_registry.h"
#include "simulator/outlier_registry.h"
#include "simulator/scene_registry.h"

namespace rcme {
namespace {

using Rows = std::vector<std::vector<std::string>>;

template <typename Entry>
Rows ListRegistry(const std::string& heading, const std::vector<Entry>& registry) {
  Rows rows = {{heading, "what it is"}};
  for (const Entry& entry : registry) rows.push_back({entry.name, entry.doc});
  return rows;
}

Rows ListScenes() {
  Rows rows = {{"scene", "cameras", "motion", "what it is"}};
  for (const SceneEntry& entry : SceneRegistry())
    rows.push_back({entry.name, entry.cameras, entry.motion, entry.doc});
  rows.push_back({kMatchFilesScene, "-", "-", "real pairs from a folder of match files"});
  return rows;
}

Rows ListCameras() {
  Rows rows = ListRegistry("cameras", CameraRegistry());
  rows.push_back({kCamerasFromFile, "two cameras of the file `calibration`"});
  return rows;
}
Rows ListEstimators() { return ListRegistry("estimator", EstimatorRegistry()); }
Rows ListMotions() { return ListRegistry("motion", MotionRegistry()); }
Rows ListNoise() { return ListRegistry("noise", NoiseRegistry()); }
Rows ListOutliers() { return ListRegistry("outliers", OutlierRegistry()); }

// The parameters of each entry; its name follows `prefix`.
template <typename Entry>
void AddParameters(const std::string& prefix, const std::vector<Entry>& registry, Rows* rows) {
  for (const Entry& entry : registry) {
    const auto model = entry.make();
    for (const Parameter& p : model->Parameters())
      rows->push_back({prefix + entry.name, p.name(), p.Value(), p.unit(), p.allowed(), p.doc()});
  }
}

Rows ListOptions() {
  Rows rows = {{"estimator", "option", "default", "unit", "allowed", "what it is"}};
  AddParameters("", EstimatorRegistry(), &rows);
  return rows;
}

// The keys that a choice brings, beside those that every simulation has.
Rows ListSettings() {
  Rows rows = {{"with", "data key", "default", "unit", "allowed", "what it is"}};
  AddParameters("scene: ", SceneRegistry(), &rows);
  for (const SettingHelp& s : DescribeSettings({{"scene", kMatchFilesScene}})) {
    rows.push_back({std::string("scene: ") + kMatchFilesScene, s.name, s.value, s.unit, s.allowed, s.doc});
  }
  AddParameters("cameras: ", CameraRegistry(), &rows);
  const SettingHelp file = CalibrationHelp();
  rows.push_back({std::string("cameras: ") + kCamerasFromFile, file.name, file.value, file.unit, file.allowed,
                  file.doc});
  AddParameters("motion: ", MotionRegistry(), &rows);
  AddParameters("noise: ", NoiseRegistry(), &rows);
  AddParameters("outliers: ", OutlierRegistry(), &rows);
  std::set<std::string> listed;
  for (const std::vector<std::string>& row : rows) listed.insert(row[1]);
  for (const SettingHelp& s : DescribeSettings({{"scene", SceneRegistry().front().name}})) {
    if (listed.count(s.name) == 0)
      rows.push_back({"any simulation", s.name, s.value, s.unit, s.allowed, s.doc});
  }
  return rows;
}

Rows ListKeys() {
  Rows rows = {{"block", "key", "default", "allowed", "what it is"}};
  for (const StudyKey& key : StudyKeys())
    rows.push_back({key.block, key.name, key.value, key.allowed, key.doc});
  return rows;
}

Rows ListQuantities() {
  Rows rows = {{"quantity", "kind", "of", "what it is"}};
  for (const QuantityHelp& q : SummaryQuantities()) rows.push_back({q.name, q.kind, q.base, q.doc});
  return rows;
}

Rows ListClaims() {
  Rows rows = {{"claim", "label", "reading", "what is claimed"}};
  for (const Claim& claim : AllClaims(EstimatorRegistry())) {
    rows.push_back({claim.id, claim.label, claim.reading, claim.sentence});
  }
  return rows;
}

// The value of a key of a shared file, as it stands there: the program may not be able to run it, because it
// lacks a library, say.
std::string ValueIn(SharedFolder folder, const std::string& name, const std::string& key) {
  const std::string path = FindSharedFolder(folder) + "/" + name + ".yaml";
  const FileKind kind = {"file", "a file of YAML"};
  const YAML::Node value = ParseYaml(ReadInputText(path, kind), path, kind)[key];
  return value && value.IsScalar() ? value.Scalar() : "";
}

Rows ListDescriptions(SharedFolder folder, const std::string& of, const std::string& what) {
  Rows rows = {{of, what}};
  for (const std::string& name : NamesIn(folder)) {
    std::string description = ValueIn(folder, name, "description");
    std::ranges::replace(description, '\n', ' ');
    rows.push_back({name, description});
  }
  return rows;
}

Rows ListStudies() { return ListDescriptions(SharedFolder::kStudies, "study", "what it asks"); }

Rows ListPopulations() {
  return ListDescriptions(SharedFolder::kPopulations, "population", "what it stands for");
}

Rows ListEstimatorFiles() {
  Rows rows = {{"estimator file", "estimator", "label"}};
  for (const std::string& name : NamesIn(SharedFolder::kEstimators)) {
    const std::string estimator = ValueIn(SharedFolder::kEstimators, name, "name");
    const std::string label = ValueIn(SharedFolder::kEstimators, name, "label");
    rows.push_back({name, estimator, label.empty() ? estimator : label});
  }
  return rows;
}

// {name of the list: [{column: text, ...}, ...]}; an empty column is left out.
void AddAsJson(const std::string& name, const Rows& rows, nlohmann::ordered_json* json) {
  nlohmann::ordered_json& list = (*json)[name] = nlohmann::ordered_json::array();
  for (size_t r = 1; r < rows.size(); ++r) {
    nlohmann::ordered_json row = nlohmann::ordered_json::object();
    for (size_t c = 0; c < rows[r].size(); ++c) {
      std::string key = rows[0][c];
      std::ranges::replace(key, ' ', '_');
      if (!rows[r][c].empty()) row[key] = rows[r][c];
    }
    list.push_back(row);
  }
}

struct List {
  std::string name, doc;
  std::function<Rows()> make;
  bool is_of_files = false;  // of those that come with the program
};

const std::vector<List>& Lists() {
  static const std::vector<List> lists = {
      {"estimators", "estimators of a study, and of --estimator", ListEstimators},
      {"options", "options of each estimator: `options` of a study, --set", ListOptions},
      {"scenes", "scenes that are simulated", ListScenes},
      {"cameras", "pairs of cameras", ListCameras},
      {"motions", "motions of the camera", ListMotions},
      {"noise", "laws of the noise of points", ListNoise},
      {"outliers", "laws of the wrong matches", ListOutliers},
      {"keys", "keys of a study file", ListKeys},
      {"settings", "keys of its block `data`, and of --set", ListSettings},
      {"quantities", "what is summarized, compared and plotted", ListQuantities},
      {"claims", "claims of the paper that `rcme audit` checks", ListClaims},
      {"studies", "studies that come with the program", ListStudies, true},
      {"populations", "populations of conditions that a study can draw from", ListPopulations, true},
      {"estimator_files", "estimators with options, for --add-estimator", ListEstimatorFiles, true}};
  return lists;
}

void PrintLists() {
  Rows rows = {{"list", "entries", "what it lists"}};
  for (const List& list : Lists())
    rows.push_back({list.name, fmt::format("{:7}", list.make().size() - 1), list.doc});
  fmt::print("{}\nPrint one with: rcme list NAME\n", FormatNarrowColumns(rows));
}

}  // namespace

void AddListCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "list",
      "List what you can name: estimators, options, scenes, study keys, quantities, claims, studies, ...");
  auto what = std::make_shared<std::string>();
  auto format = std::make_shared<std::string>("table");
  command
      ->add_option("what", *what,
                   "which list; default: what lists there are; as markdown or json: all of them except "
                   "studies, populations and estimator_files")
      ->check(MakeChoiceValidator(ListNames(Lists())));
  command->footer(R"(Examples:
  rcme list                             what lists there are
  rcme list studies
  rcme list settings
  rcme list estimators --format json)");
  command
      ->add_option("--format", *format,
                   "table: columns for a terminal; markdown: as in docs/reference; json: for programs")
      ->check(MakeChoiceValidator({"table", "markdown", "json"}))
      ->capture_default_str();
  command->callback([what, format] {
    if (what->empty() && *format == "table") return PrintLists();
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    for (const List& list : Lists()) {
      if (what->empty() ? list.is_of_files : list.name != *what) continue;
      if (*format == "json") {
        AddAsJson(list.name, list.make(), &json);
        continue;
      }
      fmt::print("{}\n", *format == "table" ? FormatNarrowColumns(list.make()) : FormatMarkdown(list.make()));
      if (*format == "table" && list.name == "estimators")
        fmt::print("{}", FormatParagraph(DescribeLeftOut()));
    }
    if (*format == "json") fmt::print("{}", JsonText(kListFormat, json));
  });
}

}  // namespace rcme
