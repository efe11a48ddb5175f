#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "experiments/study/study_plan.h"

namespace rcme {

// Lock options (study/study_lock.h) of a command that runs a study or passes it on.
struct LockArguments {
  std::string file;     // empty: the lock beside the study, if there is one
  std::string despite;  // reason for departing from the lock; empty: departures are refused
};
void AddLockOptions(CLI::App* command, LockArguments* arguments);

// Reads the study's lock into its plan and prints a message. Without a lock it does nothing. Throws
// InputError if the study departs from the lock and no reason is given, or a reason is given but there is no
// lock.
void TakeLock(const std::string& study, const LockArguments& arguments, const std::string& stopping_rule,
              StudyPlan* plan);

// Resolves a study by path or by name (core/files/shared_files.h).
std::string FindStudyFile(const std::string& study);

// The path of the lock that TakeLock reads; empty: none.
std::string FindLock(const std::string& study, const LockArguments& arguments);

}  // namespace rcme
