// Files that are installed with the program and read while it runs: studies and estimator files, by name from
// any folder, and the scripts that draw figures.
#pragma once

#include <string>
#include <vector>

#include "experiments/core/files/regular_file.h"

namespace rcme {

// The folder that holds all of it: share/rcme beside the folder bin of the running program, wherever that was
// moved to. In a build folder it holds links to the source tree. Empty: there is none.
std::string FindShare();

// Takes another folder instead, for code in a program of somebody else's, such as Python. To be called before
// anything is looked for, from one thread.
void UseShare(const std::string& folder);

enum class SharedFolder { kStudies, kEstimators, kPopulations, kPlots };

// Where its files lie. Empty: nowhere.
std::string FindSharedFolder(SharedFolder folder);

// The names of what lies there, without .yaml, in their order; of folders within it with the folder:
// "calibrated/by_difficulty".
std::vector<std::string> NamesIn(SharedFolder folder);

// The path of the file that somebody names: itself where there is such a file, else the shared file of that
// name, with or without .yaml. Where there is neither, itself; an InputError only where a shared name is near
// enough to be meant.
std::string FindFile(const std::string& name, SharedFolder folder, const FileKind& kind);

}  // namespace rcme
