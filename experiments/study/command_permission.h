// Commands that files bring. An estimator `process` runs a command of the shell, and whoever wrote the file
// that names it wrote the command. So none of them runs before the caller has allowed it: a study, an
// estimator file and a result file are data, whoever they come from. What the caller gives himself (--set
// mine.command=..., an option of a call of Python or C++) is his own, and runs.
#pragma once

#include <string>
#include <vector>

#include "experiments/study/estimator_spec.h"

namespace rcme {

inline constexpr size_t kMaxCommandBytes = 2000;  // so that a message shows all of it

// The command that the estimator, or the one that it conforms, runs; empty: none.
std::string FindCommand(const EstimatorSpec& spec);

// Whether this option of the estimator is such a command, or a file that may bring one.
bool IsCommand(const EstimatorSpec& spec, const std::string& option);

// Notes that the estimator was read from a file, at `place` ("study.yaml:7"). Throws InputError for a command
// of more than kMaxCommandBytes.
void NoteCommandPlace(const std::string& place, EstimatorSpec* spec);

// SetOptions of options that the caller gives himself: a command among them is his own.
void SetOwnOptions(EstimatorSpec* spec, const Settings& options);

// Throws InputError that shows every command that a file brought and nobody allowed, and says where it
// stands.
void RequireAllowedCommands(const std::vector<EstimatorSpec>& estimators);

// Allows them. Returns a sentence for each, to be shown before the first of them runs.
std::vector<std::string> AllowCommands(std::vector<EstimatorSpec>* estimators);

}  // namespace rcme
