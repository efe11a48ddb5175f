#include "experiments/commands/study_source.h"

#include <fmt/format.h>

#include <limits>

#include "experiments/study_file.h"
#include "parameters/input_error.h"

namespace rcme {

void AddStudyOptions(CLI::App* command, StudyChanges* changes) {
  command
      ->add_option(
          "--set", changes->overrides,
          "key=value, repeatable: a data key (sigma_px=1), an option of all estimators (mu=-2) or of one "
          "(rcme.mu=-2), or a failure bound")
      ->allow_extra_args(false);
  command->add_option("--seed", changes->seed, "seed of all random streams")
      ->check(CLI::Range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max()));
}

Study LoadChangedStudy(const std::string& path, const StudyChanges& changes) {
  Study study = LoadStudy(path);
  for (const std::string& text : changes.overrides) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw InputError(fmt::format("--set: '{}' is not allowed; give key=value", text));
    }
    Override(&study, text.substr(0, equals), text.substr(equals + 1));
  }
  if (changes.seed >= 0) study.seed = static_cast<std::uint64_t>(changes.seed);
  return study;
}

StudyPlan PlanOf(const Study& study, const std::string& path) {
  try {
    return MakePlan(study);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path, error.what()));
  }
}

const Condition& ChosenCondition(const StudyPlan& plan, std::uint32_t index) {
  if (index < plan.conditions.size()) return plan.conditions[index];
  throw InputError(fmt::format("--condition: {} is not allowed; the study has conditions 0 to {}", index,
                               plan.conditions.size() - 1));
}

}  // namespace rcme
