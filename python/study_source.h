// Binds `StudySource`, the study of a call, with Python functions as estimators.
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "experiments/study/study_plan.h"
#include "python/function_estimator.h"

namespace rcme {

// A study and the changes that a call makes to it. It is a file, or a text that messages call `study`.
struct StudySource {
  std::string path, text;
  Settings overrides;
  std::int64_t seed = -1, trials = 0;  // defaults: those of the study
  std::vector<EstimatorSpec> added;
  bool allow_process = false;  // allows commands in the study and in estimator files (command_permission.h)
  std::string Name() const { return path.empty() ? "study" : path; }
};

// Throws InputError like ParseStudy and LoadStudy, and for a label that the study already has.
Study LoadSourceStudy(const StudySource& source);
StudyPlan MakeSourcePlan(const StudySource& source, PlanEstimators estimators);

// Name -> function and hash of its source.
using Functions = std::map<std::string, std::pair<pybind11::function, std::string>>;

std::map<std::string, PythonFunction> MakeFunctions(const Functions& given);

// The source with the functions as estimators, before the estimators that it adds by name.
StudySource AddFunctions(StudySource source, const Functions& functions);

void BindStudySource(pybind11::module_& module);

}  // namespace rcme
