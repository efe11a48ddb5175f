#include "python/bind_estimate.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "estimator/protection_level.h"
#include "experiments/real/answer/probabilities_for_bounds.h"
#include "experiments/study/command_permission.h"
#include "experiments/study/estimator_file.h"
#include "experiments/trial/answer_check.h"
#include "peers/outside_answer.h"
#include "python/function_estimator.h"
#include "stats/constants.h"

namespace rcme {
namespace {

namespace py = pybind11;
using namespace py::literals;

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

// A motion's parts as Python has them: pose_cov is 6x6, of [w, dt] (peers/outside_answer.h).
py::dict DictOfMotion(const RelativePose& pose, const Matrix5d& pose_cov) {
  return py::dict("R"_a = MakeArray(pose.R), "t"_a = MakeArray(pose.t),
                  "pose_cov"_a = MakeArray(CovarianceWithTranslation(pose_cov, pose.t)));
}

// Without a direction: nothing is known of t, in the covariance either.
py::dict DictOfRotation(const MotionEstimate& estimate) {
  Eigen::MatrixXd pose_cov = Eigen::MatrixXd::Constant(6, 6, kNaN);
  pose_cov.topLeftCorner<3, 3>() = estimate.pose_cov.topLeftCorner<3, 3>();
  return py::dict("R"_a = MakeArray(estimate.cam2_from_cam1.R),
                  "t"_a = MakeArray(Eigen::Vector3d::Constant(kNaN)), "pose_cov"_a = MakeArray(pose_cov));
}

py::list MakeModesList(const MotionEstimate& estimate) {
  py::list modes;
  for (const MotionMode& mode : estimate.other_modes) {
    py::dict dict = DictOfMotion(mode.cam2_from_cam1, mode.pose_cov);
    dict["weight"] = mode.weight;
    dict["explained_share"] = mode.explained_share;
    modes.append(dict);
  }
  return modes;
}

py::list MakeProbabilityList(const std::vector<ProbabilityForBounds>& probabilities) {
  py::list list;
  for (const ProbabilityForBounds& each : probabilities)
    list.append(py::dict("rotation_deg"_a = each.bounds.max_rotation_error_deg,
                         "direction_deg"_a = each.bounds.max_direction_error_deg,
                         "p_failure"_a = each.failure_probability, "domain"_a = Name(each.domain)));
  return list;
}

py::dict MakeDict(const MotionEstimate& estimate) {
  py::dict dict("status"_a = StatusName(estimate.status), "message"_a = estimate.message,
                "motion"_a = py::none());
  if (estimate.status == MotionStatus::kOk)
    dict["motion"] = DictOfMotion(estimate.cam2_from_cam1, estimate.pose_cov);
  if (estimate.status == MotionStatus::kDirectionNotObservable) dict["motion"] = DictOfRotation(estimate);
  dict["inliers"] = estimate.inliers;
  dict["p_failure"] = estimate.failure_probability;
  dict["p_failure_domain"] = Name(estimate.probability_domain);
  dict["sigma"] = estimate.sigma_estimated_px;
  dict["sigma_sd"] = estimate.sigma_estimated_sd_px;
  dict["inlier_probabilities"] = estimate.inlier_probabilities;
  dict["other_motions"] = MakeModesList(estimate);
  return dict;
}

// {risk, rotation, direction}, rad; None without a motion.
py::object LevelsAt(const MotionEstimate& estimate, double risk) {
  if (estimate.status != MotionStatus::kOk) return py::none();
  const ProtectionLevels levels = ComputeProtectionLevels(estimate, risk);
  return py::dict("risk"_a = risk, "rotation"_a = levels.rotation_rad, "direction"_a = levels.direction_rad);
}

Camera MakeCamera(const std::array<double, 4>& k, int width, int height) {
  return {k[0], k[1], k[2], k[3], width, height};
}

py::dict Estimate(const Array& x1, const Array& x2, const Camera& camera1, const Camera& camera2,
                  double sigma_px, std::vector<double> noise_scale, const std::string& name,
                  const std::string& file, const Settings& options, std::uint64_t seed, bool allow_process,
                  const std::vector<std::pair<double, double>>& bounds, double integrity_risk) {
  std::vector<EstimatorSpec> specs = {file.empty() ? DefaultEstimator(name) : LoadEstimatorFile(file)};
  EstimatorSpec& spec = specs.front();
  SetOwnOptions(&spec, options);
  if (allow_process) AllowCommands(&specs);
  const std::unique_ptr<MotionEstimator> estimator = Make(spec);
  MotionProblem problem{{}, camera1, camera2, sigma_px, std::move(noise_scale)};
  for (py::ssize_t i = 0; i < x1.shape(0); ++i)
    problem.matches.push_back({{x1.at(i, 0), x1.at(i, 1)}, {x2.at(i, 0), x2.at(i, 1)}});
  std::vector<FailureBounds> failure_bounds;
  for (const auto& [rotation, direction] : bounds) failure_bounds.push_back({rotation, direction});
  EstimateForBounds found;
  {
    const py::gil_scoped_release unlocked;
    RandomStream rng = StreamFor({seed, 0, 0, 0}, StreamPurpose::kSampling);
    found = EstimateWithBounds(*estimator, problem, failure_bounds, rng);
  }
  const MotionEstimate judged = Judged(std::move(found.estimate), problem.matches.size());
  py::dict dict = MakeDict(judged);
  dict["protection_levels"] = LevelsAt(judged, integrity_risk);
  dict["p_failure_for_bounds"] = MakeProbabilityList(found.probabilities);
  dict["estimator"] = spec.label;
  return dict;
}

}  // namespace

void BindEstimate(py::module_& module) {
  py::class_<Camera>(module, "Camera").def(py::init(&MakeCamera));
  module.def("estimate", &Estimate);
}

}  // namespace rcme
