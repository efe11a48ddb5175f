#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "estimator/estimators/rcme_calibrated.h"
#include "estimator/protection_level.h"
#include "estimator/undistortion.h"
#include "experiments/core/work/for_each_index.h"
#include "experiments/data/camera_plausibility.h"
#include "experiments/data/colmap_camera.h"
#include "experiments/data/data_source.h"
#include "experiments/real/answer/probabilities_for_bounds.h"
#include "experiments/study/command_permission.h"
#include "experiments/study/estimator_file.h"
#include "parameters/input_error.h"
#include "peers/outside_answer.h"
#include "python/bindings.h"
#include "python/function_estimator.h"
#include "python/stoppable.h"
#include "python/study_source.h"
#include "stats/constants.h"
#include "stats/fnv1a.h"

namespace rcme {
namespace {

namespace py = pybind11;
using namespace py::literals;

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

// Writes the matrix, row-major, as element i of the array's first axis.
void SetRow(const Eigen::MatrixXd& matrix, py::ssize_t i, Array* array) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::Map<RowMajor>(array->mutable_data(i), matrix.rows(), matrix.cols()) = matrix;
}

// A motion for Python: pose_cov is 6x6, of [w, dt] (peers/outside_answer.h).
struct PythonMotion {
  Eigen::Matrix3d R;
  Eigen::Vector3d t;
  Matrix6d pose_cov;
};

PythonMotion MakeMotion(const RelativePose& pose, const Matrix5d& pose_cov) {
  return {pose.R, pose.t, CovarianceWithTranslation(pose_cov, pose.t)};
}

// The motion of an estimate; nullopt if there is none. If only the direction is missing, t and its
// covariances are NaN.
std::optional<PythonMotion> FindMotion(const MotionEstimate& estimate) {
  if (estimate.status == MotionStatus::kOk) return MakeMotion(estimate.cam2_from_cam1, estimate.pose_cov);
  if (estimate.status != MotionStatus::kDirectionNotObservable) return std::nullopt;
  PythonMotion motion{estimate.cam2_from_cam1.R, Eigen::Vector3d::Constant(kNaN), Matrix6d::Constant(kNaN)};
  motion.pose_cov.topLeftCorner<3, 3>() = estimate.pose_cov.topLeftCorner<3, 3>();
  return motion;
}

py::dict DictOfMotion(const PythonMotion& motion) {
  return py::dict("R"_a = MakeArray(motion.R), "t"_a = MakeArray(motion.t),
                  "pose_cov"_a = MakeArray(motion.pose_cov));
}

py::list MakeModesList(const MotionEstimate& estimate) {
  py::list modes;
  for (const MotionMode& mode : estimate.other_modes) {
    py::dict dict = DictOfMotion(MakeMotion(mode.cam2_from_cam1, mode.pose_cov));
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
  if (const std::optional<PythonMotion> motion = FindMotion(estimate)) dict["motion"] = DictOfMotion(*motion);
  dict["inliers"] = estimate.inliers;
  dict["p_failure"] = estimate.failure_probability;
  dict["p_failure_domain"] = Name(estimate.probability_domain);
  dict["prior"] = Name(estimate.prior);
  dict["prior_p_value"] = estimate.prior_p_value;
  dict["calibration_error_probability"] = estimate.calibration_error_probability;
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

Lens MakeCamera(const std::string& model, const std::vector<double>& parameters, int width, int height) {
  return MakeNamedLens(model, parameters, {width, height}, model);
}

std::vector<Correspondence> MakeMatches(const Array& x1, const Array& x2) {
  std::vector<Correspondence> matches;
  for (py::ssize_t i = 0; i < x1.shape(0); ++i)
    matches.push_back({{x1.at(i, 0), x1.at(i, 1)}, {x2.at(i, 0), x2.at(i, 1)}});
  return matches;
}

// What is suspicious about the cameras (experiments/data/camera_plausibility.h), each with its place.
std::vector<std::string> ListCameraDoubts(const Array& x1, const Array& x2, const Lens& camera1,
                                          const Lens& camera2, const std::array<std::string, 2>& places,
                                          const std::array<bool, 2>& are_sizes_known) {
  std::vector<std::string> doubts;
  for (const InputDoubt& doubt : FindPairDoubts(camera1.camera, camera2.camera, MakeMatches(x1, x2), places,
                                                are_sizes_known, {camera1.model, camera2.model}))
    doubts.push_back(doubt.place + ": " + doubt.what);
  return doubts;
}

struct ChosenEstimator {
  EstimatorSpec spec;
  std::unique_ptr<MotionEstimator> estimator;
};

// `file`: empty, or a path that replaces the name. `functions`: Python functions that the name, or an option
// of the estimator, may refer to.
ChosenEstimator MakeChosen(const std::string& name, const std::string& file, const Settings& options,
                           bool allow_process, const Functions& functions) {
  const FunctionsOfCall of_call(MakeFunctions(functions));
  const auto function = functions.find(name);
  std::vector<EstimatorSpec> specs = {!file.empty() ? LoadEstimatorFile(file)
                                      : function != functions.end()
                                          ? SpecOfFunction(name, function->second.second)
                                          : DefaultEstimator(name)};
  SetOwnOptions(&specs.front(), options);
  if (allow_process) AllowCommands(&specs);
  return {specs.front(), Make(specs.front())};
}

UndistortedProblem MakeProblem(const Array& x1, const Array& x2, const Lens& camera1, const Lens& camera2,
                               double sigma_px, std::vector<double> noise_scale) {
  MotionProblem problem{MakeMatches(x1, x2), {}, {}, sigma_px, std::move(noise_scale)};
  return UndistortProblem(camera1, camera2, std::move(problem));
}

// The answer to a pair of `num_matches` matches, in terms of these.
EstimateForBounds Answer(const MotionEstimator& estimator, const UndistortedProblem& pair, size_t num_matches,
                         const PosteriorRequest& request, std::uint64_t seed) {
  EstimateForBounds found = AnswerProblem(estimator, pair.problem, request, seed);
  RestoreDistorted(pair.problem, pair.kept, num_matches, &found.estimate);
  return found;
}

// Row-major and checked by the package; an empty list means not measured. `rotation`: R, then its covariance,
// rad^2; `gravity`: in camera 1, in camera 2, standard deviation of both; `direction`: t, standard deviation.
MotionPrior MakePrior(const std::vector<double>& rotation, const std::vector<double>& gravity,
                      const std::vector<double>& direction) {
  const auto vector = [](const std::vector<double>& numbers, size_t first) {
    return Eigen::Vector3d(numbers.at(first), numbers.at(first + 1), numbers.at(first + 2));
  };
  MotionPrior prior;
  if (!rotation.empty()) {
    using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    if (rotation.size() != 18) throw py::value_error("a rotation with its covariance has 18 numbers");
    prior.rotation = {RowMajor(rotation.data()), RowMajor(rotation.data() + 9)};
  }
  if (!gravity.empty()) {
    prior.gravity = {vector(gravity, 0).normalized(), vector(gravity, 3).normalized(), gravity.at(6),
                     gravity.at(6)};
  }
  if (!direction.empty()) prior.direction = {vector(direction, 0).normalized(), direction.at(3)};
  return prior;
}

// Pairs (rotation, direction), deg.
using AnglePairs = std::vector<std::pair<double, double>>;

std::vector<FailureBounds> MakeBounds(const AnglePairs& pairs) {
  std::vector<FailureBounds> bounds;
  for (const auto& [rotation, direction] : pairs) bounds.push_back({rotation, direction});
  return bounds;
}

// The stream of a pair's random motions: those of different pairs do not depend on each other.
RandomStream StreamOfDraws(const MotionProblem& problem, std::uint64_t seed) {
  Fnv1a hash;
  for (const Correspondence& match : problem.matches)
    for (const Eigen::Vector2d& x_px : {match.x1_px, match.x2_px})
      for (const double coordinate : x_px) hash.Add(coordinate);
  return StreamFor({seed, hash.value() >> 16, 0, 0}, StreamPurpose::kMonteCarlo);
}

// Random motions of the posterior; NaN: none of its motions.
std::vector<RelativePose> DrawMotions(const MotionPosterior& posterior, int num_draws, RandomStream rng) {
  const RelativePose none{Eigen::Matrix3d::Constant(kNaN), Eigen::Vector3d::Constant(kNaN)};
  std::vector<RelativePose> motions(static_cast<size_t>(num_draws));
  RunStoppable([&] {
    for (RelativePose& motion : motions) {
      if (IsStopRequested()) throw Stopped("stopped");
      motion = Draw(posterior, rng).value_or(none);
    }
  });
  return motions;
}

// {R, t}: n x 3 x 3 and n x 3.
py::dict DictOfMotions(const std::vector<RelativePose>& motions) {
  Array R({motions.size(), size_t{3}, size_t{3}}), t({motions.size(), size_t{3}});
  for (size_t i = 0; i < motions.size(); ++i) {
    SetRow(motions[i].R, static_cast<py::ssize_t>(i), &R);
    SetRow(motions[i].t, static_cast<py::ssize_t>(i), &t);
  }
  return py::dict("R"_a = R, "t"_a = t);
}

py::dict EstimatePair(const Array& x1, const Array& x2, const Lens& camera1, const Lens& camera2,
                      double sigma_px, std::vector<double> noise_scale, const std::string& name,
                      const std::string& file, const Settings& options, std::uint64_t seed,
                      bool allow_process, const AnglePairs& bounds, int num_draws, double integrity_risk,
                      const std::optional<MotionPrior>& prior, const Functions& functions) {
  const ChosenEstimator chosen = MakeChosen(name, file, options, allow_process, functions);
  UndistortedProblem pair = MakeProblem(x1, x2, camera1, camera2, sigma_px, std::move(noise_scale));
  pair.problem.prior = prior;
  if (num_draws > 0 && FindWeightInspection(*chosen.estimator) == nullptr)
    throw InputError(
        "draws: only rcme_calibrated, without model_choice or conform, states a distribution of the motion");
  const PosteriorRequest request{MakeBounds(bounds), num_draws > 0};
  EstimateForBounds found;
  {
    const py::gil_scoped_release unlocked;
    found = Answer(*chosen.estimator, pair, static_cast<size_t>(x1.shape(0)), request, seed);
  }
  py::dict dict = MakeDict(found.estimate);
  dict["protection_levels"] = LevelsAt(found.estimate, integrity_risk);
  dict["p_failure_for_bounds"] = MakeProbabilityList(found.probabilities);
  dict["draws"] = py::none();
  if (found.posterior)
    dict["draws"] =
        DictOfMotions(DrawMotions(*found.posterior, num_draws, StreamOfDraws(pair.problem, seed)));
  dict["estimator"] = chosen.spec.label;
  return dict;
}

// Arrays with one row per pair; NaN where a value is unknown.
class AnswerArrays {
 public:
  AnswerArrays(size_t num_pairs, size_t num_bounds)
      : R_({num_pairs, size_t{3}, size_t{3}}),
        t_({num_pairs, size_t{3}}),
        pose_cov_({num_pairs, size_t{6}, size_t{6}}),
        p_failure_(num_pairs),
        p_for_bounds_({num_pairs, num_bounds}),
        sigma_(num_pairs),
        sigma_sd_(num_pairs) {
    for (Array* array : {&R_, &t_, &pose_cov_, &p_failure_, &p_for_bounds_, &sigma_, &sigma_sd_})
      std::fill_n(array->mutable_data(), array->size(), kNaN);
  }

  void Set(py::ssize_t i, const EstimateForBounds& found) {
    const MotionEstimate& estimate = found.estimate;
    if (const std::optional<PythonMotion> motion = FindMotion(estimate)) {
      SetRow(motion->R, i, &R_);
      SetRow(motion->t, i, &t_);
      SetRow(motion->pose_cov, i, &pose_cov_);
    }
    p_failure_.mutable_at(i) = estimate.failure_probability;
    for (size_t k = 0; k < found.probabilities.size(); ++k)
      p_for_bounds_.mutable_at(i, static_cast<py::ssize_t>(k)) = found.probabilities[k].failure_probability;
    sigma_.mutable_at(i) = estimate.sigma_estimated_px;
    sigma_sd_.mutable_at(i) = estimate.sigma_estimated_sd_px;
    status_.append(StatusName(estimate.status));
    domain_.append(Name(estimate.probability_domain));
    inliers_.append(estimate.inliers);
  }

  py::dict MakeDict() const {
    return py::dict("status"_a = status_, "R"_a = R_, "t"_a = t_, "pose_cov"_a = pose_cov_,
                    "p_failure"_a = p_failure_, "p_failure_domain"_a = domain_,
                    "p_failure_for_bounds"_a = p_for_bounds_, "sigma"_a = sigma_, "sigma_sd"_a = sigma_sd_,
                    "inliers"_a = inliers_);
  }

 private:
  Array R_, t_, pose_cov_, p_failure_, p_for_bounds_, sigma_, sigma_sd_;
  py::list status_, domain_, inliers_;
};

// x1, x2, camera1, camera2, noise_scale.
using GivenPair = std::tuple<Array, Array, Lens, Lens, std::vector<double>>;

std::vector<EstimateForBounds> AnswerOnThreads(const MotionEstimator& estimator,
                                               std::span<const GivenPair> pairs,
                                               const std::vector<UndistortedProblem>& undistorted,
                                               const PosteriorRequest& request, std::uint64_t seed,
                                               int threads) {
  std::vector<EstimateForBounds> found(pairs.size());
  RunStoppable([&] {
    ForEachIndex(std::ssize(pairs), threads, [&](std::int64_t i) {
      const auto place = static_cast<size_t>(i);
      const auto num_matches = static_cast<size_t>(std::get<0>(pairs[place]).shape(0));
      found[place] = Answer(estimator, undistorted[place], num_matches, request, seed);
    });
    if (IsStopRequested()) throw Stopped("stopped");
  });
  return found;
}

py::dict EstimateMany(const std::vector<GivenPair>& pairs, double sigma_px, const std::string& name,
                      const std::string& file, const Settings& options, std::uint64_t seed,
                      bool allow_process, const AnglePairs& bounds, int threads, const Functions& functions) {
  const ChosenEstimator chosen = MakeChosen(name, file, options, allow_process, functions);
  const PosteriorRequest request{MakeBounds(bounds)};
  AnswerArrays arrays(pairs.size(), bounds.size());
  constexpr size_t kNumTogether = 2'000;  // number of pairs whose full answers are in memory at a time
  for (size_t begin = 0; begin < pairs.size(); begin += kNumTogether) {
    const std::span block = std::span(pairs).subspan(begin, std::min(kNumTogether, pairs.size() - begin));
    std::vector<UndistortedProblem> undistorted;
    for (const auto& [x1, x2, camera1, camera2, noise_scale] : block)
      undistorted.push_back(MakeProblem(x1, x2, camera1, camera2, sigma_px, noise_scale));
    const std::vector<EstimateForBounds> found =
        AnswerOnThreads(*chosen.estimator, block, undistorted, request, seed, threads);
    for (size_t i = 0; i < found.size(); ++i) arrays.Set(static_cast<py::ssize_t>(begin + i), found[i]);
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  py::dict dict = arrays.MakeDict();
  dict["estimator"] = chosen.spec.label;
  return dict;
}

}  // namespace

void BindEstimate(py::module_& module) {
  py::class_<Lens>(module, "Camera").def(py::init(&MakeCamera));
  py::class_<MotionPrior>(module, "MotionPrior").def(py::init(&MakePrior));
  module.def("camera_doubts", &ListCameraDoubts);
  module.def("estimate", &EstimatePair);
  module.def("estimate_many", &EstimateMany);
}

}  // namespace rcme
