#include "experiments/data/simulated_data.h"

#include <fmt/format.h>

#include <cmath>

#include "estimator/noise_scale.h"
#include "estimator/undistortion.h"
#include "simulator/noise_registry.h"
#include "simulator/outlier_registry.h"
#include "stats/constants.h"
#include "stats/median_ratio.h"

namespace rcme {
namespace {

Choices WithDefaults(Choices choices) {
  if (choices.noise.empty()) choices.noise = "gaussian";
  if (choices.outliers.empty()) choices.outliers = "uniform";
  return choices;
}

// Normal noise from given numbers.
class GivenNoise : public NoiseModel {
 public:
  GivenNoise(double sigma_px, std::span<const double> normals) : normals_(normals) { sigma_px_ = sigma_px; }
  std::vector<Parameter> Parameters() override { return {}; }
  void AddTo(std::span<Correspondence> matches, RandomStream&) const override {
    for (size_t i = 0; i < matches.size(); ++i) {
      const double* e = &normals_[4 * i];
      matches[i].x1_px += Eigen::Vector2d(e[0] * sigma_px_, e[1] * sigma_px_);
      matches[i].x2_px += Eigen::Vector2d(e[2] * sigma_px_, e[3] * sigma_px_);
    }
  }

 private:
  std::span<const double> normals_;
};

// Returns the measurements of the sensors as estimators get them; nothing without a measurement.
std::optional<MotionPrior> MakePrior(const Scene& scene, const MotionSensors& sensors, RandomStream& rng) {
  if (sensors.IsNone()) return std::nullopt;
  const MeasuredMotion measured = sensors.Measure(scene, rng);
  MotionPrior prior;
  const double rotation_sd = kRadPerDeg * sensors.rotation_sd_deg,
               gravity_sd = kRadPerDeg * sensors.gravity_sd_deg;
  if (measured.R) prior.rotation = {*measured.R, rotation_sd * rotation_sd * Eigen::Matrix3d::Identity()};
  if (measured.gravity)
    prior.gravity = {measured.gravity->front(), measured.gravity->back(), gravity_sd, gravity_sd};
  if (measured.t) prior.direction = {*measured.t, kRadPerDeg * sensors.direction_sd_deg};
  if (CountPriorFreedom(prior) == 0) return std::nullopt;
  return prior;
}

// Returns what `make` returns; turns an InputError of the simulation into NotSimulated.
template <typename Make>
auto Simulate(const Make& make) {
  try {
    return make();
  } catch (const InputError& error) {
    throw NotSimulated(error.what());
  }
}

// Selects elements of `all`; `which` is ascending.
template <typename T>
std::vector<T> Select(std::vector<T> all, const std::vector<size_t>& which) {
  if (which.size() == all.size()) return all;
  std::vector<T> selected;
  selected.reserve(which.size());
  for (const size_t i : which) selected.push_back(all[i]);
  return selected;
}

}  // namespace

SimulatedData::SimulatedData(const Choices& choices)
    : choices_(WithDefaults(choices)),
      scenes_(choices.scene, choices.cameras, choices.motion),
      noise_(FindEntry(NoiseRegistry(), "noise", choices_.noise).make()),
      outliers_(FindEntry(OutlierRegistry(), "outliers", choices_.outliers).make()) {
  choices_.cameras = scenes_.cameras();
  choices_.motion = scenes_.motion();
}

std::vector<Parameter> SimulatedData::Parameters() {
  std::vector<Parameter> all = SceneParameters();
  for (const std::vector<Parameter>& more :
       {noise_->Parameters(), rcme::Parameters(outliers_), rcme::Parameters(defects_),
        rcme::Parameters(assumed_), rcme::Parameters(sensors_)}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  all.push_back(Parameter::Choice<bool>("severity", &measures_severity_,
                                        {{"measured", true}, {"skipped", false}},
                                        "whether trials store the severity of their problem"));
  return all;
}

void SimulatedData::FixBaseline() const {
  std::call_once(baseline_once_, [this] {
    try {
      // Uses the same scenes for every seed of the study.
      scenes_.FixBaseline({0, 0, 0, static_cast<std::uint32_t>(StreamPurpose::kPilotScene)});
    } catch (const InputError& error) {
      baseline_error_ = error.what();
    }
  });
  if (!baseline_error_.empty()) throw NotSimulated(baseline_error_);
}

TrialData SimulatedData::Make(const StreamName& trial_name) const {
  return MakeFrom(DrawScene(trial_name), trial_name);
}

std::string SimulatedData::Identity() const {
  FixBaseline();
  const double baseline_m = scenes_.BaselineOfParallax();
  return std::isnan(baseline_m) ? "" : fmt::format("baseline_m {:.6g}", baseline_m);
}

Settings SimulatedData::ChosenParts() const {
  return {{"scene", choices_.scene},
          {"cameras", choices_.cameras},
          {"motion", choices_.motion},
          {"noise", choices_.noise},
          {"outliers", choices_.outliers}};
}

Scene SimulatedData::DrawScene(const StreamName& trial_name) const {
  FixBaseline();
  RandomStream scene_rng = StreamFor(trial_name, StreamPurpose::kScene);
  return Simulate([&] { return scenes_.Generate(scene_rng); });
}

Scene SimulatedData::DrawSceneWithMotion(const Motion& motion, RandomStream& rng) const {
  FixBaseline();
  return Simulate([&] { return scenes_.GenerateWith(motion, rng); });
}

std::optional<Scene> SimulatedData::DrawSceneNear(const Motion& motion, double step,
                                                  RandomStream& rng) const {
  FixBaseline();
  const std::optional<Motion> near = scenes_.motion_model().DrawNear(motion, step, rng);
  if (!near) return std::nullopt;
  return Simulate([&] { return std::optional<Scene>(scenes_.GenerateWith(*near, rng)); });
}

TrialData SimulatedData::MakeFrom(const Scene& scene, const StreamName& trial_name) const {
  RandomStream noise_rng = StreamFor(trial_name, StreamPurpose::kNoise);
  RandomStream outlier_rng = StreamFor(trial_name, StreamPurpose::kOutliers);
  Observation observation =
      Simulate([&] { return Observe(scene, *noise_, outliers_, noise_rng, outlier_rng, defects_); });

  Severity severity;
  if (measures_severity_) {
    RandomStream severity_rng = StreamFor(trial_name, StreamPurpose::kSeverity);
    severity = MeasureSeverity(scene, observation, noise_->sigma_px(), severity_rng);
  }
  RandomStream prior_rng = StreamFor(trial_name, StreamPurpose::kPrior);
  TrialData data = Give(scene, std::move(observation), prior_rng);
  data.severity = severity;
  return data;
}

TrialData SimulatedData::MakeFrom(const Scene& scene, std::span<const double> normals,
                                  RandomStream& outlier_rng) const {
  RandomStream unused = StreamFor({}, StreamPurpose::kNoise);
  const GivenNoise noise(noise_->sigma_px(), normals);
  Observation observation =
      Simulate([&] { return Observe(scene, noise, outliers_, unused, outlier_rng, defects_); });
  return Give(scene, std::move(observation), outlier_rng);
}

Lens SimulatedData::AssumedLens(const SceneCamera& camera_true) const {
  Lens lens = camera_true.AsLens();
  lens.camera = assumed_.AssumedCamera(lens.camera);
  return lens;
}

TrialData SimulatedData::Give(const Scene& scene, Observation observation, RandomStream& prior_rng) const {
  TrialData data;
  // sigma_px is that of the median match if matches have individual noise levels.
  const double median = observation.noise_scale.empty() ? 1.0 : ComputeMedian(observation.noise_scale);
  MotionProblem as_taken = {std::move(observation.matches),
                            {},
                            {},
                            assumed_.AssumedSigma(median * noise_->sigma_px()),
                            ComputeNoiseScale(std::move(observation.noise_scale)),
                            MakePrior(scene, sensors_, prior_rng)};
  UndistortedProblem undistorted =
      UndistortProblem(AssumedLens(scene.camera1), AssumedLens(scene.camera2), std::move(as_taken));
  data.problem = std::move(undistorted.problem);
  data.truth = {scene.cam2_from_cam1_true, scene.IsDirectionDefined(),
                Select(std::move(observation.is_inlier_true), undistorted.kept),
                Select(std::move(observation.is_undetectable), undistorted.kept)};
  data.origin = "simulated";
  data.weight = observation.weight;
  data.scene_point = Select(std::move(observation.point), undistorted.kept);
  return data;
}

}  // namespace rcme
