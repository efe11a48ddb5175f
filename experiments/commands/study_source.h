// The study of a command, with the changes of the command line, and one condition of it.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "experiments/run/store/result_store.h"
#include "experiments/study/study_plan.h"

namespace rcme {

struct StudyChanges {
  std::vector<std::string> overrides;   // key=value each
  std::vector<std::string> estimators;  // estimator files, to be added
  std::int64_t seed = -1;               // negative: the study's own
  bool allow_process = false;           // the commands of the files (process_option.h)

  bool AreAny() const { return !overrides.empty() || !estimators.empty() || seed >= 0; }
};

// The options --set, --add-estimator and --seed.
void AddStudyOptions(CLI::App* command, StudyChanges* changes);

// The study of a YAML file, changed: estimators are added first, so that --set reaches them too. Says which
// commands it allows. Throws InputError (study_file.h, estimator_file.h), also for a label that the study has
// already.
Study LoadChangedStudy(const std::string& path, const StudyChanges& changes);

// Whether a file begins as every SQLite file does: a result of `rcme run`, not a study.
bool IsResultFile(const std::string& path);

// The plan of a result file's study, its commands allowed or refused. Throws InputError as ResultStore::Plan.
StudyPlan PlanOfStored(const ResultStore& store, bool allow_process);

// The seed of a command that may go without a study: --seed, or 1. Throws InputError for options that change
// a study.
std::uint64_t SeedWithoutStudy(const StudyChanges& changes);

// The condition that --condition names. Throws InputError that says which there are.
const Condition& ChosenCondition(const StudyPlan& plan, std::uint32_t index);

}  // namespace rcme
