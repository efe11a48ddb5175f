#pragma once

#include <memory>
#include <string>

#include "experiments/run/store/result_file.h"
#include "experiments/core/work/shard.h"
#include "experiments/study/study_plan.h"

namespace rcme {

// A read-write connection that no other run shares.
inline constexpr const char* kTakeLock = "PRAGMA locking_mode = EXCLUSIVE; BEGIN IMMEDIATE; COMMIT";

// Throws InputError where no result file can be.
void CheckPathToWrite(const std::string& path);

// Throws Damage if a description is not that of its study.
void CheckFits(const RunDescription& run, const StudyPlan& plan);

// What a run keeps: every trial, or counts (counts_tables.h).
enum class Keep { kTrials, kCounts };

// Opens the file of this plan's study and shard, or makes it, for one run alone; checks all of it but the
// counts. What earlier runs asked for is still asked for. Errors are those of ResultFile, and InputError
// where the path cannot be written or the file is of another study or shard, or keeps something else.
std::unique_ptr<ResultFile> OpenFileForRun(const std::string& path, const StudyPlan& plan, const Shard& shard,
                                           Keep keep);

// Notes in a description that trials of this origin follow. Returns a sentence of warning if there are trials
// of another one, else nothing.
std::string NoteOriginIn(RunDescription* run, const std::string& path, bool has_trials,
                         const TrialOrigin& origin);

}  // namespace rcme
