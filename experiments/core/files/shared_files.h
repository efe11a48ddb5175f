// Files that are installed with the program and read at run time: studies, estimator files and populations,
// found by name from any folder, and the scripts that draw figures.
#pragma once

#include <string>
#include <vector>

#include "experiments/core/files/regular_file.h"

namespace rcme {

// Returns the folder of all shared files: share/rcme beside the folder bin of the running program, wherever
// the program was moved. In a build folder it holds links to the source tree. Empty if there is none.
std::string FindShare();

// Sets another folder, for a program that embeds this code, such as Python. Call it before any search, from
// one thread.
void UseShare(const std::string& folder);

enum class SharedFolder { kStudies, kEstimators, kPopulations, kPlots };

// Returns the path of a shared folder, or an empty text if there is none.
std::string FindSharedFolder(SharedFolder folder);

// Lists the names of the YAML files in a shared folder, sorted and without ".yaml". A file in a subfolder
// has the subfolder in its name: "calibrated/by_difficulty".
std::vector<std::string> NamesIn(SharedFolder folder);

// Resolves a file given by path or by name. If `name` exists as a path, returns it. Else returns the path of
// the shared file of that name, which may be given with or without ".yaml". Else returns `name`; throws
// InputError with a suggestion if a shared file has a similar name.
std::string FindFile(const std::string& name, SharedFolder folder, const FileKind& kind);

}  // namespace rcme
