// The files that the command of an estimator `process` names, such as its script. They belong to what
// identifies a run: answers of two versions of a script must not be mixed.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/study/estimator_spec.h"

namespace rcme {

// Returns a hash of the bytes of a file.
std::string HashFile(const std::string& path);

// Returns each regular file that the shell command names, with a hash of its bytes, in the command's order.
// Programs found through PATH, files read by the named ones, and files that the shell writes (`2> log.txt`)
// are not included.
std::vector<std::pair<std::string, std::string>> ListFilesOfCommand(const std::string& command);

// Returns one hash of all of them.
std::string HashFilesOfCommand(const std::string& command);

// Returns a line for the identity of a run (study_plan.h) for each of these files; empty if no command names
// one.
std::string IdentifyCommandFiles(const std::vector<EstimatorSpec>& estimators);

// Returns whether a line of an identity is one of them.
bool IsOfCommandFile(const std::string& line);

// If two identities differ only in these lines, returns the first file that changed, with its estimator:
// "file est.py of estimator mine". Else nothing.
std::optional<std::string> FindChangedCommandFile(const std::string& there, const std::string& here);

}  // namespace rcme
