// The study of a call: `StudySource`, and the functions that are estimators of it.
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

// A study and what a call changes in it. One that is no file is a text, whose messages call it `study`.
struct StudySource {
  std::string path, text;
  Settings overrides;
  std::int64_t seed = -1, trials = 0;  // the study's own
  std::vector<EstimatorSpec> added;
  bool allow_process = false;  // the commands of the study and of estimator files (command_permission.h)
  std::string Name() const { return path.empty() ? "study" : path; }
};

// Throws InputError as ParseStudy and LoadStudy, also for a label that the study has already.
Study LoadSourceStudy(const StudySource& source);
StudyPlan MakeSourcePlan(const StudySource& source, PlanEstimators estimators);

// By name: the function, and a hash of its source.
using Functions = std::map<std::string, std::pair<pybind11::function, std::string>>;

std::map<std::string, PythonFunction> MakeFunctions(const Functions& given);

// The source with the functions as estimators, in front of those that it adds by name.
StudySource AddFunctions(StudySource source, const Functions& functions);

void BindStudySource(pybind11::module_& module);

}  // namespace rcme
