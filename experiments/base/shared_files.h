// Studies and estimator files that come with the program, by name, from any folder.
#pragma once

#include <string>
#include <vector>

#include "experiments/base/regular_file.h"

namespace rcme {

enum class SharedFolder { kStudies, kEstimators };

// Where they lie: beside the running program (../share/rcme/studies), else in the source tree that it was
// built from, else where that was to be installed. Empty: nowhere.
std::string PathOf(SharedFolder folder);

// The names of what lies there, without .yaml, in their order; of folders within it with the folder:
// "calibrated/by_difficulty".
std::vector<std::string> NamesIn(SharedFolder folder);

// The path of the file that somebody names: itself where there is such a file, else the shared file of that
// name, with or without .yaml. Where there is neither, itself; an InputError only where a shared name is near
// enough to be meant.
std::string FindFile(const std::string& name, SharedFolder folder, const FileKind& kind);

}  // namespace rcme
