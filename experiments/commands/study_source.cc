#include "experiments/commands/study_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "experiments/commands/common_options.h"
#include "experiments/core/text/key_value.h"
#include "experiments/study/absent_python.h"
#include "experiments/study/estimator_file.h"
#include "experiments/study/study_file.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

void AddEstimatorOfFile(const std::string& path, Study* study) {
  EstimatorSpec spec = LoadEstimatorFile(path);
  if (std::ranges::count(study->estimators, spec.label, &EstimatorSpec::label) > 0) {
    throw InputError(
        fmt::format("--add-estimator: {}: the study has an estimator '{}' already; give the file another "
                    "label, or list it in the study as {{file: {}, label: ANOTHER}}",
                    path, spec.label, path));
  }
  study->estimators.push_back(std::move(spec));
}

}  // namespace

void AddStudyOptions(CLI::App* command, StudyChanges* changes) {
  command
      ->add_option("--set", changes->overrides,
                   "key=value, repeatable: a data key (sigma_px=1), a failure bound, or an option of one "
                   "estimator (rcme.mu=-2) "
                   "or of all that have it (mu=-2)")
      ->allow_extra_args(false);
  command
      ->add_option(
          "--add-estimator", changes->estimators,
          "estimator file (YAML: name, label, options), repeatable: one more estimator on the same trials")
      ->allow_extra_args(false);
  command->add_option("--seed", changes->seed, "seed of all random streams")->transform(WholeNumberIn(0));
}

Study LoadChangedStudy(const std::string& path, const StudyChanges& changes) {
  Study study = LoadStudy(path);
  for (const std::string& file : changes.estimators) AddEstimatorOfFile(file, &study);
  for (const std::string& text : changes.overrides) {
    const auto [key, value, has_equals] = SplitKeyValue(text);
    if (!has_equals || key.empty()) {
      throw InputError(fmt::format("--set: '{}' is not allowed; give key=value", text));
    }
    Override(&study, key, value);
  }
  if (changes.seed >= 0) study.seed = static_cast<std::uint64_t>(changes.seed);
  if (changes.allow_process) AllowAndSay(&study.estimators);
  return study;
}

bool IsResultFile(const std::string& path) {
  constexpr std::string_view kBeginning("SQLite format 3\0", 16);
  std::string bytes(kBeginning.size(), ' ');
  if (!std::filesystem::is_regular_file(path)) return false;
  std::ifstream(path, std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return bytes == kBeginning;
}

StudyPlan PlanOfStored(const ResultStore& store, bool allow_process) {
  AddAbsentPython(store.Description().study_yaml);
  Study study = store.StoredStudy();
  if (allow_process) AllowAndSay(&study.estimators);
  return store.Plan(study);
}

std::uint64_t SeedWithoutStudy(const StudyChanges& changes) {
  if (!changes.overrides.empty() || !changes.estimators.empty()) {
    throw InputError(fmt::format("{}: not allowed without a study; give one: rcme COMMAND STUDY ...",
                                 changes.overrides.empty() ? "--add-estimator" : "--set"));
  }
  return changes.seed < 0 ? 1 : static_cast<std::uint64_t>(changes.seed);
}

const Condition& ChosenCondition(const StudyPlan& plan, std::uint32_t index) {
  if (index < plan.conditions.size()) return plan.conditions[index];
  throw InputError(fmt::format("--condition: {} is not allowed; the study has conditions 0 to {}", index,
                               plan.conditions.size() - 1));
}

}  // namespace rcme
