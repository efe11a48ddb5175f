// Permission for commands that come from files. The estimator `process` runs a shell command, and whoever
// wrote the file that names it wrote the command. No such command runs before the caller has allowed it,
// because studies, estimator files and result files are data that may come from anybody. Options that the
// caller gives directly (--set mine.command=..., an option of a call from Python or C++) need no permission.
#pragma once

#include <string>
#include <vector>

#include "experiments/study/estimator_spec.h"

namespace rcme {

// Returns the command that the estimator runs, or that the estimator which it conforms runs; empty if none.
std::string FindCommand(const EstimatorSpec& spec);

// Returns whether this option of the estimator is a command or names a file that may contain one.
bool IsCommand(const EstimatorSpec& spec, const std::string& option);

// Records that the estimator was read from a file, at `place` ("study.yaml:7"). Throws InputError if its
// command is longer than 2,000 bytes.
void NoteCommandPlace(const std::string& place, EstimatorSpec* spec);

// SetOptions for options that the caller gives directly: a command among them needs no permission. A command
// inside a file of `rcme conform` still does.
void SetOwnOptions(EstimatorSpec* spec, const Settings& options);

// Throws InputError if a command from a file has not been allowed; the message shows every such command and
// where it is.
void RequireAllowedCommands(const std::vector<EstimatorSpec>& estimators);

// Allows all commands. Returns a sentence for each, to be shown before the first of them runs.
std::vector<std::string> AllowCommands(std::vector<EstimatorSpec>* estimators);

}  // namespace rcme
