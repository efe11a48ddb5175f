#include "experiments/run/store/open_for_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "experiments/core/files/first_difference.h"
#include "experiments/study/command_files.h"
#include "experiments/study/study_file.h"
#include "experiments/study/study_lock.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

// Makes the connection exclusive, so no other run can use the file.
constexpr const char* kTakeLock = "PRAGMA locking_mode = EXCLUSIVE; BEGIN IMMEDIATE; COMMIT";

// Describes the plan's run in a file of earlier runs: trials that these planned stay planned, and their
// notes stay.
RunDescription Continued(const RunDescription& earlier, const StudyPlan& plan) {
  RunDescription run = Describe(plan);
  if (earlier.trials > run.trials) {
    Study study = plan.study;
    study.trials = run.trials = earlier.trials;
    run.study_yaml = ToYaml(study);
  }
  for (size_t c = 0; c < run.conditions.size(); ++c) {
    run.conditions[c].num_trials = std::max(run.conditions[c].num_trials, earlier.conditions[c].num_trials);
  }
  run.shard = earlier.shard;
  run.keeps_counts = earlier.keeps_counts;
  run.stopping_rule = earlier.stopping_rule;
  run.until_options = earlier.until_options;
  run.until_trials = earlier.until_trials;
  run.retried_trials = earlier.retried_trials;
  run.despite_lock = JoinReasons(earlier.despite_lock, run.despite_lock);
  run.origin = earlier.origin;
  return run;
}

RunDescription Requested(const StudyPlan& plan, const Shard& shard, Keep keep) {
  RunDescription run = Describe(plan);
  run.shard = shard.Text();
  run.keeps_counts = keep == Keep::kCounts;
  return run;
}

// Says what a file keeps, and of which shard.
std::string DescribeHeld(const RunDescription& run) {
  return fmt::format("{} of {}", run.keeps_counts ? "counts" : "trials",
                     run.shard.empty() ? "the whole study" : "shard " + run.shard);
}

// Throws InputError unless the wanted run continues the file, which holds trials.
void CheckIsThatRun(const ResultFile& file, const RunDescription& wanted) {
  const RunDescription& held = file.description;
  if (const auto changed = FindChangedCommandFile(held.identity, wanted.identity)) {
    throw InputError(
        fmt::format("{}: holds answers of another version: {} is not what it was. Give another --out, or "
                    "restore the file",
                    file.path, *changed));
  }
  if (held.identity != wanted.identity) {
    throw InputError(
        fmt::format("{}: holds the results of another study, run by {}; first difference: {}. Give another "
                    "--out",
                    file.path, held.origin.program, FirstDifference(held.identity, wanted.identity)));
  }
  if (held.lock != wanted.lock) {
    throw InputError(
        fmt::format("{}: holds trials that were run {}, this run is {}: what was decided before a run cannot "
                    "change. Give "
                    "another --out, or the lock of then with --lock",
                    file.path, DescribeLock(held.lock), DescribeLock(wanted.lock)));
  }
  if (DescribeHeld(held) != DescribeHeld(wanted)) {
    throw InputError(fmt::format("{}: holds the {}, not {}. Give another --out", file.path,
                                 DescribeHeld(held), DescribeHeld(wanted)));
  }
}

// Adds a name to a list separated by commas, unless it is there.
std::string WithName(const std::string& names, const std::string& name) {
  if (names.empty()) return name;
  const bool has_it = (", " + names + ",").find(", " + name + ",") != std::string::npos;
  return has_it ? names : names + ", " + name;
}

}  // namespace

void CheckPathToWrite(const std::string& path) {
  if (path.empty()) throw InputError("--out: '' is not allowed; give the path of a result file");
  const std::filesystem::path parent = std::filesystem::path(path).parent_path();
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (error && status.type() != std::filesystem::file_type::not_found)
    throw InputError(fmt::format("{}: cannot be written: {}", path, error.message()));
  if (std::filesystem::is_directory(status))
    throw InputError(fmt::format("{}: is a folder, not a result file", path));
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw InputError(fmt::format("{}: cannot be written as a result file: it is a device or a pipe", path));
  if (!parent.empty() && !std::filesystem::is_directory(parent))
    throw InputError(fmt::format("{}: folder '{}' does not exist", path, parent.string()));
}

void CheckFits(const RunDescription& run, const StudyPlan& plan) {
  if (plan.conditions.size() != run.conditions.size() ||
      plan.study.estimators.size() != run.estimators.size())
    throw Damage("its tables are not those of its study");
}

std::unique_ptr<ResultFile> OpenFileForRun(const std::string& path, const StudyPlan& plan, const Shard& shard,
                                           Keep keep) {
  CheckPathToWrite(path);
  const RunDescription wanted = Requested(plan, shard, keep);
  auto file = std::make_unique<ResultFile>(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  file->database.exec(kTakeLock);  // at once, so that a second run stops here
  if (file->IsNew()) {
    file->Create(wanted);
  } else {
    file->LoadDescription();
    file->CheckTrials();
    file->CheckPages();
  }
  if (file->totals.NumTrials() > 0) CheckIsThatRun(*file, wanted);
  // A file without trials (its run failed at once) accepts any study and any shard.
  if (file->description.identity != wanted.identity || file->description.lock != wanted.lock ||
      DescribeHeld(file->description) != DescribeHeld(wanted)) {
    file->Create(wanted);
  } else {
    CheckFits(file->description, plan);
    const RunDescription run = Continued(file->description, plan);
    const bool says_the_same =
        run.study_yaml == file->description.study_yaml && run.despite_lock == file->description.despite_lock;
    if (!says_the_same) file->SetDescription(run);
  }
  return file;
}

std::string NoteOriginIn(RunDescription* run, const std::string& path, bool has_trials,
                         const TrialOrigin& origin) {
  const TrialOrigin before = run->origin;
  run->origin = {WithName(before.program, origin.program),
                 WithName(before.instruction_set, origin.instruction_set)};
  if (run->origin == origin || !has_trials) return {};
  return fmt::format(
      "{}: its trials come from {} ({}), new ones will come from {} ({}), and may differ in their last bits",
      path, before.program, before.instruction_set, origin.program, origin.instruction_set);
}

}  // namespace rcme
