#include "experiments/study/estimator_file.h"

#include "estimator/conform/conform_file.h"
#include "experiments/core/files/shared_files.h"
#include "experiments/study/command_permission.h"
#include "experiments/study/estimator_entry.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

const FileKind& EstimatorFileKind() {
  static const FileKind kind = {"estimator file", "an estimator file"};
  return kind;
}

constexpr const char* kHowToUse =
    "# How to use it: in a study `estimators: [{file: tuned.yaml}]`, `rcme run STUDY --add-estimator "
    "tuned.yaml`, `rcme estimate MATCHES --estimator-file tuned.yaml`\n";

}  // namespace

EstimatorSpec LoadEstimatorFile(const std::string& name) {
  const std::string path = FindFile(name, SharedFolder::kEstimators, EstimatorFileKind());
  return ParseEstimatorFile(ReadInputText(path, EstimatorFileKind()), path);
}

EstimatorSpec ParseEstimatorFile(const std::string& yaml, const std::string& path) {
  return ReadEstimatorEntry(Place(path), ParseYaml(yaml, path, EstimatorFileKind()), "estimator");
}

std::optional<std::string> FindInstalledFile(const std::string& label) {
  for (const std::string& name : NamesIn(SharedFolder::kEstimators)) {
    try {
      if (LoadEstimatorFile(name).label == label) return name;
    } catch (const InputError&) {  // of an estimator that this build lacks
    }
  }
  return std::nullopt;
}

EstimatorSpec LoadConformedEstimator(const std::string& path) {
  const ConformRule rule = ReadConformFile(path).rule;
  EstimatorSpec spec{rule.estimator, rule.estimator, rule.options, {}};
  NoteCommandPlace(path, &spec);
  return spec;
}

std::string EstimatorFileText(const EstimatorSpec& spec, const Provenance& provenance) {
  YAML::Emitter out;
  out << YAML::BeginMap;
  WriteEstimatorKeys(spec, &out);
  if (!provenance.empty()) {
    out << YAML::Key << "provenance" << YAML::Value << YAML::BeginMap;
    for (const auto& [key, text] : provenance) out << YAML::Key << key << YAML::Value << text;
    out << YAML::EndMap;
  }
  out << YAML::EndMap;
  return kHowToUse + std::string(out.c_str()) + "\n";
}

}  // namespace rcme
