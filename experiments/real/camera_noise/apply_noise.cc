#include "experiments/real/camera_noise/apply_noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimator/robust_covariance/covariance_option.h"
#include "experiments/real/camera_noise/systematic_displacement.h"
#include "experiments/real/truth_free/camera_faults.h"
#include "experiments/real/truth_free/twin_source.h"
#include "parameters/input_error.h"
#include "stats/fnv1a.h"

namespace rcme {
namespace {

constexpr auto kReadoutFault = static_cast<size_t>(CameraFault::kReadoutTime);

bool IsSameCamera(const Camera& camera, const Camera& other) {
  return camera.width == other.width && camera.height == other.height && camera.K().isApprox(other.K(), 1e-4);
}

bool RemovesAnything(const CameraNoise& noise) {
  return noise.systematic.columns > 0 ||
         std::ranges::any_of(noise.corrections, [](const CameraCorrection& c) { return c.removed != 0.0; });
}

void CheckCamera(const Camera& camera, const CameraNoise& noise, const std::string& origin) {
  const Camera& of = noise.camera;
  if (IsSameCamera(camera, of)) return;
  throw InputError(
      fmt::format("{}: its camera ({} x {}, fx fy cx cy {:.6g} {:.6g} {:.6g} {:.6g}) is not that of the "
                  "noise file ({} x {}, "
                  "{:.6g} {:.6g} {:.6g} {:.6g}); calibrate the noise of this one",
                  origin, camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy, of.width,
                  of.height, of.fx, of.fy, of.cx, of.cy));
}

// The faults that are removed; the readout alone or the others.
FaultVector ListRemoved(const CameraNoise& noise, bool is_readout) {
  FaultVector faults = FaultVector::Zero();
  for (const CameraCorrection& each : noise.corrections) {
    if ((each.fault == kReadoutFault) == is_readout)
      faults(static_cast<Eigen::Index>(each.fault)) = each.removed;
  }
  return faults;
}

class SharedNoiseEstimator : public MotionEstimator {
 public:
  SharedNoiseEstimator(std::unique_ptr<MotionEstimator> estimator, const CameraNoise& noise, bool is_robust)
      : estimator_(std::move(estimator)), noise_(noise), is_robust_(is_robust) {}
  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    MotionEstimate estimate = estimator_->Estimate(problem, rng);
    WidenCovariance(problem, noise_, is_robust_, &estimate);
    return estimate;
  }

 private:
  std::unique_ptr<MotionEstimator> estimator_;
  CameraNoise noise_;
  bool is_robust_;
};

}  // namespace

MotionProblem ApplyNoise(MotionProblem problem, const CameraNoise& noise, const std::string& origin) {
  problem.sigma_px = noise.sigma_px.value;
  if (std::isfinite(noise.size_exponent.value)) {
    for (double& scale : problem.noise_scale) scale = std::pow(scale, noise.size_exponent.value);
  }
  if (!RemovesAnything(noise)) return problem;
  CheckCamera(problem.camera1, noise, origin);
  CheckCamera(problem.camera2, noise, origin);
  problem = RemoveFaults(std::move(problem), {}, ListRemoved(noise, false));
  for (Correspondence& match : problem.matches) {
    match.x1_px -= DisplacementAt(noise.systematic, problem.camera1, match.x1_px);
    match.x2_px -= DisplacementAt(noise.systematic, problem.camera2, match.x2_px);
  }
  return problem;
}

bool RemovesReadout(const CameraNoise& noise) { return !ListRemoved(noise, true).isZero(0.0); }

MotionProblem CorrectReadout(MotionProblem problem, const RelativePose& cam2_from_cam1,
                             const CameraNoise& noise) {
  return RemoveFaults(std::move(problem), cam2_from_cam1, ListRemoved(noise, true));
}

void WidenCovariance(const MotionProblem& problem, const CameraNoise& noise, bool is_robust,
                     MotionEstimate* estimate) {
  const double all = noise.sigma_px.value * noise.sigma_px.value,
               key_point = noise.key_point_px * noise.key_point_px,
               field = noise.displacement_px.value * noise.displacement_px.value;
  if (estimate->status != MotionStatus::kOk) return;
  if (key_point == 0.0 && field == 0.0 && !is_robust) return;
  RobustCovarianceOptions options;
  KnownVariances known{std::max(0.0, 1.0 - (key_point + field) / all), key_point / all, field / all};
  if (noise.reach_px > 0.0) known.length_px = noise.reach_px;
  options.known_variances = known;
  const std::optional<Matrix5d> own_cov = is_robust ? std::nullopt : std::optional(estimate->pose_cov);
  MakeCovarianceRobust(problem, options, own_cov, estimate);
}

std::unique_ptr<MotionEstimator> WithSharedNoise(std::unique_ptr<MotionEstimator> estimator,
                                                 const CameraNoise& noise, bool is_robust) {
  return std::make_unique<SharedNoiseEstimator>(std::move(estimator), noise, is_robust);
}

PairSet ApplyNoiseTo(PairSet set, const CameraNoise& noise, const MotionEstimator& estimator,
                     std::uint64_t seed) {
  for (NamedPair& pair : set.pairs) {
    pair.problem = ApplyNoise(std::move(pair.problem), noise, pair.name);
    if (!RemovesReadout(noise)) continue;
    const MotionEstimate estimate =
        AnswerTo(pair.problem, estimator, {seed, HashToStreamKey(pair.name), 0, 0});
    if (estimate.status == MotionStatus::kOk)
      pair.problem = CorrectReadout(std::move(pair.problem), estimate.cam2_from_cam1, noise);
  }
  return set;
}

}  // namespace rcme
