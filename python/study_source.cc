#include "python/study_source.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "estimator/conform/conform_estimator.h"
#include "experiments/study/command_permission.h"
#include "experiments/study/estimator_file.h"
#include "experiments/study/study_file.h"
#include "parameters/input_error.h"

namespace rcme {

namespace py = pybind11;

Study LoadSourceStudy(const StudySource& source) {
  Study study = source.path.empty() ? ParseStudy(source.text, source.Name()) : LoadStudy(source.path);
  for (const EstimatorSpec& spec : source.added) {
    if (std::ranges::count(study.estimators, spec.label, &EstimatorSpec::label) > 0) {
      throw InputError(
          fmt::format("estimators: the study has an estimator '{}' already; give another label", spec.label));
    }
    study.estimators.push_back(spec);
  }
  for (const auto& [key, value] : source.overrides) Override(&study, key, value);
  if (source.seed >= 0) study.seed = static_cast<std::uint64_t>(source.seed);
  if (source.trials > 0) study.trials = static_cast<int>(source.trials);
  if (source.allow_process) AllowCommands(&study.estimators);
  return study;
}

StudyPlan MakeSourcePlan(const StudySource& source, PlanEstimators estimators) {
  return MakePlan(LoadSourceStudy(source), source.Name(), estimators);
}

std::map<std::string, PythonFunction> MakeFunctions(const Functions& given) {
  std::map<std::string, PythonFunction> functions;
  for (const auto& [name, function] : given) functions[name] = {function.first, function.second};
  return functions;
}

StudySource AddFunctions(StudySource source, const Functions& functions) {
  std::vector<EstimatorSpec> added;
  for (const auto& [name, function] : functions) added.push_back(SpecOfFunction(name, function.second));
  source.added.insert(source.added.begin(), added.begin(), added.end());
  return source;
}

void BindStudySource(py::module_& module) {
  py::class_<StudySource>(module, "StudySource")
      .def(py::init([](const std::string& path, const std::string& text, const Settings& overrides,
                       std::int64_t seed, std::int64_t trials, bool allow_process) {
        return StudySource{path, text, overrides, seed, trials, {}, allow_process};
      }))
      .def("add_estimator",
           [](StudySource& source, const std::string& label, const std::string& name,
              const Settings& options) {
             EstimatorSpec spec = DefaultEstimator(name);
             SetOwnOptions(&spec, options);
             if (!label.empty()) spec.label = label;
             // Throws if two options contradict each other. The estimator that `conform` wraps may be a
             // function, or a command that is not permitted yet, so it is made by the plan instead.
             if (spec.name != kConformEstimator) Make(spec);
             source.added.push_back(spec);
           })
      .def("add_estimator_file", [](StudySource& source, const std::string& label, const std::string& path) {
        EstimatorSpec spec = LoadEstimatorFile(path);
        if (!label.empty()) spec.label = label;
        source.added.push_back(spec);
      });
}

}  // namespace rcme
