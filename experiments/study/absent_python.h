// Estimators that are functions of Python (`name: python`), in a program without Python.
#pragma once

#include <string>

namespace rcme {

inline constexpr const char* kPythonEstimator = "python";

// Adds the entry `python` to the registry if the study (YAML) of a result file names it, so that the trials of
// the file can be made again. Its estimators answer nothing (status no_answer). Call it before the study is
// read.
void AddAbsentPython(const std::string& study_yaml);

}  // namespace rcme
