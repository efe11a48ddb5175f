#include "experiments/real/camera_noise/apply_noise.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "estimator/noise_scale.h"
#include "estimator/robust_covariance/covariance_option.h"
#include "experiments/real/camera_noise/systematic_displacement.h"
#include "experiments/real/truth_free/calibration_score.h"
#include "experiments/real/truth_free/twin.h"
#include "experiments/real/truth_free/twin_source.h"
#include "parameters/input_error.h"
#include "stats/fnv1a.h"

namespace rcme {
namespace {

constexpr auto kReadoutFault = static_cast<size_t>(CameraFault::kReadoutTime);

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

// The faults that the file removes: only the readout, or all others.
FaultVector ListRemoved(const CameraNoise& noise, bool is_readout) {
  FaultVector faults = FaultVector::Zero();
  for (const CameraCorrection& each : noise.corrections) {
    if ((each.fault == kReadoutFault) == is_readout)
      faults(static_cast<Eigen::Index>(each.fault)) = each.removed;
  }
  return faults;
}

// The file's variances, divided by sigma^2.
KnownVariances FindKnownVariances(const CameraNoise& noise) {
  const double key_point = noise.key_point_px / noise.sigma_px.value;
  KnownVariances known;
  known.of_key_point = key_point * key_point;
  const bool is_found = noise.displacement_px.value > 0.0;
  const double field = (is_found ? noise.displacement_px.value : noise.unseen_px) / noise.sigma_px.value,
               reach_px = is_found ? noise.reach_px : noise.unseen_reach_px;
  known.of_neighbours = std::min(1.0, field * field);
  known.own = std::max(0.0, 1.0 - known.of_key_point - known.of_neighbours);
  if (reach_px > 0.0) known.length_px = reach_px;
  return known;
}

bool IsOfCamera(const MotionProblem& problem, const CameraNoise& noise) {
  // Corrected cameras differ from that of the file; ApplyNoise compared them before the correction.
  return RemovesAnything(noise) ||
         (IsSameCamera(problem.camera1, noise.camera) && IsSameCamera(problem.camera2, noise.camera));
}

// G U G'.
Matrix5d ComputeCovarianceOfFaults(const MotionProblem& problem, const CameraNoise& noise,
                                   const MotionEstimate& estimate) {
  const std::vector<CameraCorrection>& faults = noise.corrections;
  const bool is_sure =
      std::ranges::all_of(faults, [](const CameraCorrection& each) { return each.uncertainty == 0.0; });
  if (is_sure || !IsOfCamera(problem, noise)) return Matrix5d::Zero();
  const MatchScores scores = ScoreFitted(problem, estimate.inliers, estimate.cam2_from_cam1);
  const Eigen::Matrix3d F = ComputeFundamental(problem, estimate.cam2_from_cam1);
  Eigen::Matrix<double, 5, kNumCameraFaults> mixed = Eigen::Matrix<double, 5, kNumCameraFaults>::Zero();
  for (size_t i = 0; i < scores.rows.size(); ++i) {
    const double sigma_px =
        problem.sigma_px * NoiseScaleAt(problem, static_cast<size_t>(estimate.inliers[i]));
    mixed +=
        scores.rows[i] *
        ResidualByFaults(F, problem.camera1, problem.camera2, estimate.cam2_from_cam1, scores.matches[i]) /
        sigma_px;
  }
  const Eigen::Matrix<double, 5, kNumCameraFaults> moved = scores.information.ldlt().solve(mixed);
  Matrix5d covariance = Matrix5d::Zero();
  for (size_t a = 0; a < faults.size(); ++a) {
    for (size_t b = 0; b < faults.size(); ++b) {
      const double shared = noise.uncertainty_correlations[a * faults.size() + b] * faults[a].uncertainty *
                            faults[b].uncertainty;
      covariance += shared * moved.col(static_cast<Eigen::Index>(faults[a].fault)) *
                    moved.col(static_cast<Eigen::Index>(faults[b].fault)).transpose();
    }
  }
  return covariance.allFinite() ? covariance : Matrix5d::Zero();
}

// tr(A C): the variance over that of independent errors, summed over directions; zero without a motion.
double ComputeWidth(const MotionProblem& problem, const MotionEstimate& estimate) {
  if (estimate.status != MotionStatus::kOk) return 0.0;
  const MatchScores scores = ScoreFitted(problem, estimate.inliers, estimate.cam2_from_cam1);
  return (scores.information * estimate.pose_cov).trace();
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

CameraNoise ReadNoiseToApply(const std::string& path) {
  CameraNoise noise = ReadCameraNoise(path);
  for (const CameraCorrection& each : noise.corrections) {
    const double greatest = GreatestFault(kCameraFaults[each.fault], noise.camera);
    if (std::abs(each.removed) > greatest)
      throw InputError(
          fmt::format("{}: camera_faults: {}: removed {:g} is not allowed; at most {:g} either way", path,
                      kCorrectableFaults[each.fault], each.removed, greatest));
  }
  return noise;
}

bool IsSameCamera(const Camera& camera, const Camera& other) {
  return camera.width == other.width && camera.height == other.height && camera.K().isApprox(other.K(), 1e-4);
}

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
                             const CameraNoise& noise, double seconds_between) {
  const double scale = noise.seconds_between / seconds_between;
  return RemoveFaults(std::move(problem), cam2_from_cam1,
                      (std::isfinite(scale) ? scale : 1.0) * ListRemoved(noise, true));
}

void WidenCovariance(const MotionProblem& problem, const CameraNoise& noise, bool is_robust,
                     MotionEstimate* estimate) {
  if (estimate->status != MotionStatus::kOk) return;
  RobustCovarianceOptions options;
  options.known_variances = FindKnownVariances(noise);
  const Matrix5d exact = CovarianceWithoutErrors(*estimate);
  estimate->pose_cov = exact;
  const std::optional<Matrix5d> own_cov = is_robust ? std::nullopt : std::optional(exact);
  MotionEstimate by_file = *estimate;
  if (options.known_variances->own < 1.0) MakeCovarianceRobust(problem, options, own_cov, &by_file);
  if (!is_robust || ComputeWidth(problem, by_file) > ComputeWidth(problem, *estimate))
    *estimate = std::move(by_file);
  if (estimate->status != MotionStatus::kOk) return;
  estimate->pose_cov += ComputeCovarianceOfFaults(problem, noise, *estimate);
  if (!(estimate->calibration_error_probability > 0.0)) return;
  estimate->pose_cov_with_errors += estimate->pose_cov - exact;
  estimate->pose_cov_without_errors = estimate->pose_cov;
  MixErrors(estimate);
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
      pair.problem =
          CorrectReadout(std::move(pair.problem), estimate.cam2_from_cam1, noise, pair.seconds_between);
  }
  return set;
}

}  // namespace rcme
