#include "experiments/study/estimator_entry.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "estimator/conform/conform_estimator.h"
#include "estimator/estimator_registry.h"
#include "experiments/core/files/shared_files.h"
#include "experiments/study/command_permission.h"
#include "experiments/study/study_keys.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "parameters/suggestion.h"

namespace rcme {
namespace {

// The options of the entry, and the others at their defaults, as the estimator formats them.
void ReadOptions(const Place& place, const YAML::Node& node, EstimatorSpec* spec) {
  const std::unique_ptr<EstimatorModel> model = Configure(*spec);
  const std::vector<Parameter> parameters = model->Parameters();
  for (const auto& [option, text] : Entries(place, node, "options", {})) {
    place.At(text, [&, option = option, text = text] {
      FindOption(spec->name, parameters, option).SetFromText(Scalar(place, text, option));
    });
  }
  spec->options = ListValues(parameters);
}

// {process: COMMAND} is short for the estimator `process` with that command, {answers: FILE} for `answers`
// with that file, {conform: FILE} for `conform` with that file. Paths are relative to the folder of the file
// that has the entry.
void ReadShortForm(const Place& place, const YAML::Node& value, const std::string& key, EstimatorSpec* spec) {
  const std::string text = Scalar(place, value, key);
  if (text.empty()) place.Fail(value, fmt::format("{}: is empty", key));
  spec->name = key;
  const std::filesystem::path file = std::filesystem::path(place.path()).parent_path() / text;
  place.At(value, [&] {
    SetOptions(spec, key == "process"   ? Settings{{"command", text}}
                     : key == "answers" ? AnswersOptions(file.string())
                                        : ConformOptions(file.string()));
  });
}

Parameter BudgetParameter(double* budget_ms) {
  return Parameter::Real("budget_ms", budget_ms, {kLeastBudgetMs, kMostBudgetMs}, "ms",
                         "time of a call that the effort was chosen for");
}

}  // namespace

std::string ReadLabel(const Place& place, const YAML::Node& node) {
  const std::string label = Name(place, node, "label");
  if (label.find(',') != std::string::npos) {
    place.Fail(node, fmt::format("label: {} is not allowed; give one without a comma, which separates labels "
                                 "in lists (--estimators A,B)",
                                 Quoted(label)));
  }
  return label;
}

std::string DescribeLeftOut() {
  if (std::ranges::count(EstimatorRegistry(), "poselib", &EstimatorEntry::name) > 0) return {};
  return "PoseLib was not found when rcme was built, so poselib and poselib_gravity are left out: install it "
         "(https://github.com/PoseLib/PoseLib), then configure the build again with "
         "-DCMAKE_PREFIX_PATH=FOLDER_OF_POSELIB";
}

void RequireEstimatorName(const std::string& name) {
  if (name.starts_with("poselib") && !DescribeLeftOut().empty())
    throw InputError(fmt::format("unknown estimator {}: {}", Quoted(name), DescribeLeftOut()));
  if (IsNameOfEstimatorFile(name)) {
    throw InputError(fmt::format("unknown estimator {0}; {0} is an estimator file: write {{file: {1}}}",
                                 Quoted(name), name));
  }
  std::vector<std::string> names, files = NamesIn(SharedFolder::kEstimators);
  for (const EstimatorEntry& entry : EstimatorRegistry()) names.push_back(entry.name);
  if (std::ranges::count(names, name) > 0) return;
  std::vector<std::string> all = names;
  all.insert(all.end(), files.begin(), files.end());
  throw InputError(fmt::format("unknown estimator {}{}; known: {}; estimator files: {}", Quoted(name),
                               DidYouMean(name, all), fmt::join(names, ", "),
                               files.empty() ? "none" : fmt::format("{}", fmt::join(files, ", "))));
}

bool IsNameOfEstimatorFile(const std::string& name) {
  if (std::ranges::count(EstimatorRegistry(), name, &EstimatorEntry::name) > 0) return false;
  const std::vector<std::string> files = NamesIn(SharedFolder::kEstimators);
  return std::ranges::count(files, name) > 0;
}

EstimatorSpec ReadEstimatorEntry(const Place& place, const YAML::Node& node, const std::string& block,
                                 const std::set<std::string>& keys_of_caller) {
  EstimatorSpec spec;
  std::set<std::string> known = ListStudyKeys("estimator");
  known.insert(keys_of_caller.begin(), keys_of_caller.end());
  for (const auto& [key, value] : Entries(place, node, block, known)) {
    const bool is_short = key == "process" || key == "answers" || key == kConformEstimator;
    if ((key == "name" || is_short) && !spec.name.empty())
      place.Fail(value,
                 fmt::format("{}: name, process, answers and conform exclude each other; give one", block));
    if (key == "name") spec.name = Name(place, value, key);
    if (is_short) ReadShortForm(place, value, key, &spec);
    if (key == "label") spec.label = ReadLabel(place, value);
    if (key == "budget_ms") {
      place.At(value, [&, value = value] {
        BudgetParameter(&spec.budget_ms.emplace()).SetFromText(Scalar(place, value, "budget_ms"));
      });
    }
    if (key != "provenance") continue;
    for (const auto& [what, text] : Entries(place, value, key, {})) Scalar(place, text, what);
  }
  if (spec.name.empty()) place.Fail(node, fmt::format("{}: key 'name' is missing", block));
  if (spec.label.empty()) spec.label = spec.name;
  const YAML::Node options = node["options"] ? node["options"] : YAML::Node(YAML::NodeType::Map);
  if (node["name"]) place.At(node["name"], [&] { RequireEstimatorName(spec.name); });
  ReadOptions(place, options, &spec);
  place.At(node, [&] {
    Configure(spec)->Make();  // throws where two options contradict each other
    const YAML::Node command = node["process"] ? node["process"] : options["command"];
    NoteCommandPlace(place.Text(command ? command : node), &spec);
  });
  return spec;
}

void WriteEstimatorKeys(const EstimatorSpec& spec, YAML::Emitter* out) {
  *out << YAML::Key << "name" << YAML::Value << spec.name;
  *out << YAML::Key << "label" << YAML::Value << spec.label;
  *out << YAML::Key << "options" << YAML::Value << YAML::BeginMap;
  for (const auto& [option, value] : spec.options) *out << YAML::Key << option << YAML::Value << value;
  *out << YAML::EndMap;
  if (spec.budget_ms) *out << YAML::Key << "budget_ms" << YAML::Value << fmt::format("{:g}", *spec.budget_ms);
}

}  // namespace rcme
