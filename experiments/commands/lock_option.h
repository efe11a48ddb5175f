#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "experiments/study/study_plan.h"

namespace rcme {

// The options of a command that runs a study, or hands it on, about its lock (study/study_lock.h).
struct LockArguments {
  std::string file;     // empty: the one beside the study, if there is one
  std::string despite;  // why the study departs from it; empty: it does not
};
void AddLockOptions(CLI::App* command, LockArguments* arguments);

// Puts the lock into the plan of the study of a file, and says so; does nothing where there is none.
// Throws InputError where the study departs from the lock and no reason was given.
void TakeLock(const std::string& study, const LockArguments& arguments, const std::string& stopping_rule,
              StudyPlan* plan);

// The path of a study that somebody names (core/files/shared_files.h).
std::string FindStudyFile(const std::string& study);

// The path of the lock that TakeLock takes; empty: none.
std::string FindLock(const std::string& study, const LockArguments& arguments);

}  // namespace rcme
