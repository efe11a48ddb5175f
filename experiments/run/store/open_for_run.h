#pragma once

#include <memory>
#include <string>

#include "experiments/core/work/shard.h"
#include "experiments/run/store/result_file.h"
#include "experiments/study/study_plan.h"

namespace rcme {

// Throws InputError if `path` cannot be a result file.
void CheckPathToWrite(const std::string& path);

// Throws Damage if the numbers of conditions or estimators in a description are not those of its study.
void CheckFits(const RunDescription& run, const StudyPlan& plan);

// A run keeps every trial, or only counts (counts_tables.h).
enum class Keep { kTrials, kCounts };

// Opens the file of this plan's study and shard for this run alone, or makes it. Checks all of it except the
// counts. If an earlier run planned more trials, they stay planned. Throws the errors of ResultFile, and
// InputError if the path cannot be written, or if the file is of another study or shard or keeps something
// else.
std::unique_ptr<ResultFile> OpenFileForRun(const std::string& path, const StudyPlan& plan, const Shard& shard,
                                           Keep keep);

// Adds the origin of the following trials to a description. Returns a warning if the file has trials of
// another origin, else an empty text.
std::string NoteOriginIn(RunDescription* run, const std::string& path, bool has_trials,
                         const TrialOrigin& origin);

}  // namespace rcme
