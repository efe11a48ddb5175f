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
  std::vector<std::string> estimators;  // estimator files to add
  std::int64_t seed = -1;               // negative: the study's own
  bool allow_process = false;           // allow the commands that the files name (--allow-process)

  bool AreAny() const { return !overrides.empty() || !estimators.empty() || seed >= 0; }
};

// The options --set, --add-estimator and --seed.
void AddStudyOptions(CLI::App* command, StudyChanges* changes);

// Loads a study file and applies the changes. Estimators are added first, so that --set applies to them too.
// Prints which commands it allows. Throws InputError (study_file.h, estimator_file.h), also if an added
// estimator has a label that the study already uses.
Study LoadChangedStudy(const std::string& path, const StudyChanges& changes);

// Whether a file has the header of an SQLite file and thus is a result of `rcme run` rather than a study.
bool IsResultFile(const std::string& path);

// The plan of a result file's study, with its commands allowed or not. Throws InputError as ResultStore::Plan
// does.
StudyPlan PlanOfStored(const ResultStore& store, bool allow_process);

// The seed of a command that was given no study: --seed, or 1. Throws InputError for options that change a
// study.
std::uint64_t SeedWithoutStudy(const StudyChanges& changes);

// The condition that --condition selects. Throws InputError with the allowed range.
const Condition& ChosenCondition(const StudyPlan& plan, std::uint32_t index);

}  // namespace rcme
