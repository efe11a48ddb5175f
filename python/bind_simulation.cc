#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cstdint>

#include "experiments/data/match_file.h"
#include "experiments/trial/severity_columns.h"
#include "parameters/input_error.h"
#include "python/bindings.h"
#include "python/function_estimator.h"
#include "python/study_source.h"

namespace rcme {
namespace {

namespace py = pybind11;
using namespace py::literals;

py::dict MakeLevelsDict(const StudyPlan& plan, const Condition& condition) {
  py::dict levels;
  for (size_t f = 0; f < plan.factor_names.size(); ++f)
    levels[py::str(plan.factor_names[f])] = condition.levels[f];
  return levels;
}

py::list Conditions(const StudySource& source) {
  const StudyPlan plan = MakeSourcePlan(source, PlanEstimators::kNotMade);
  py::list rows;
  for (const Condition& condition : plan.conditions) {
    py::dict row("condition"_a = condition.index);
    for (const auto& [factor, level] : MakeLevelsDict(plan, condition)) row[factor] = level;
    row["trials"] = condition.num_trials;
    rows.append(row);
  }
  return rows;
}

py::dict MakeTruthDict(const TrialData& data) {
  const Truth& truth = data.truth;
  py::dict dict("R"_a = py::none(), "t"_a = py::none(), "inliers"_a = py::none(),
                "undetectable"_a = py::none());
  if (truth.cam2_from_cam1_true) {
    dict["R"] = MakeArray(truth.cam2_from_cam1_true->R);
    if (truth.is_direction_known) dict["t"] = MakeArray(truth.cam2_from_cam1_true->t);
  }
  if (!truth.is_inlier_true.empty()) dict["inliers"] = py::array(py::cast(truth.is_inlier_true));
  if (!truth.is_undetectable.empty()) dict["undetectable"] = py::array(py::cast(truth.is_undetectable));
  return dict;
}

// As estimate_relative_pose takes it; None without measurements.
py::object MakePriorDict(const std::optional<MotionPrior>& prior) {
  if (!prior) return py::none();
  py::dict dict;
  if (prior->rotation) {
    dict["rotation"] = MakeArray(prior->rotation->R);
    dict["rotation_cov"] = MakeArray(prior->rotation->cov);
  }
  if (prior->gravity) {
    dict["gravity1"] = MakeArray(prior->gravity->in_cam1);
    dict["gravity2"] = MakeArray(prior->gravity->in_cam2);
    dict["gravity_sd_deg"] = kDegPerRad * prior->gravity->sd1_rad;
  }
  if (prior->direction) {
    dict["direction"] = MakeArray(prior->direction->t);
    dict["direction_sd_deg"] = kDegPerRad * prior->direction->sd_rad;
  }
  return dict;
}

py::dict Simulate(const StudySource& source, std::int64_t condition_index, std::int64_t trial) {
  const StudyPlan plan = MakeSourcePlan(source, PlanEstimators::kNotMade);
  if (condition_index >= static_cast<std::int64_t>(plan.conditions.size())) {
    throw InputError(fmt::format("condition: {} is not allowed; the study has conditions 0 to {}",
                                 condition_index, plan.conditions.size() - 1));
  }
  const Condition& condition = plan.conditions[static_cast<size_t>(condition_index)];
  const StreamName name = NameOfScene(plan, condition, static_cast<std::uint32_t>(trial));
  const TrialData data = condition.source->Make(name);
  const MotionProblem& problem = data.problem;
  py::dict severity;
  for (const SeverityColumn& column : kSeverityColumns) severity[column.name] = data.severity.*column.field;
  return py::dict(
      "x1"_a = MakePoints(problem.matches, &Correspondence::x1_px),
      "x2"_a = MakePoints(problem.matches, &Correspondence::x2_px), "camera1"_a = MakeDict(problem.camera1),
      "camera2"_a = MakeDict(problem.camera2), "sigma_px"_a = problem.sigma_px,
      "noise_scale"_a = ScalesOrNone(problem), "prior"_a = MakePriorDict(problem.prior),
      "truth"_a = MakeTruthDict(data), "severity"_a = severity, "levels"_a = MakeLevelsDict(plan, condition),
      "origin"_a = data.origin, "weight"_a = data.weight, "condition"_a = condition.index, "trial"_a = trial);
}

}  // namespace

void BindSimulation(py::module_& module) {
  module.def("conditions", &Conditions);
  module.def("simulate", &Simulate);
  module.def("format_prior", &FormatPrior);
}

}  // namespace rcme
