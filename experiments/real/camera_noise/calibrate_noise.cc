#include "experiments/real/camera_noise/calibrate_noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/real/camera_noise/apply_noise.h"
#include "experiments/real/camera_noise/fault_posterior.h"
#include "experiments/real/camera_noise/fitted_pairs.h"
#include "experiments/real/camera_noise/systematic_displacement.h"
#include "experiments/real/truth_free/self_calibration.h"
#include "experiments/real/truth_free/twin_source.h"
#include "parameters/input_error.h"
#include "stats/constants.h"
#include "stats/distributions.h"
#include "stats/fnv1a.h"
#include "stats/median_ratio.h"

namespace rcme {
namespace {

constexpr size_t kLeastPairsOfCamera = 5;
constexpr double kSystematicLevel = 0.05;
// Of the intervals of PoolFaults, each.
constexpr double kIntervalConfidence = 1.0 - (1.0 - kFaultConfidence) / kNumNamedFaults;
constexpr double kSizeEdges[] = {0.0, 0.7, 1.0, 1.4, 2.0, 4.0, kInfinity};

std::vector<PairAnswers> AnswerAll(const PairSet& set, const MotionEstimator& estimator, std::uint64_t seed) {
  std::vector<PairAnswers> answers;
  for (const NamedPair& pair : set.pairs) {
    MotionEstimate estimate = AnswerTo(pair.problem, estimator, {seed, HashToStreamKey(pair.name), 0, 0});
    if (estimate.status == MotionStatus::kOk) answers.push_back({{pair, std::move(estimate)}, {}});
  }
  return answers;
}

// The pairs of the same camera as the first pair.
PairSet SelectCamera(const PairSet& set) {
  PairSet selected{set.name, {}};
  if (set.pairs.empty()) return selected;
  const Camera camera = set.pairs.front().problem.camera1;
  for (const NamedPair& pair : set.pairs) {
    if (IsSameCamera(pair.problem.camera1, camera) && IsSameCamera(pair.problem.camera2, camera))
      selected.pairs.push_back(pair);
  }
  return selected;
}

// Root of a variance, with the error of first order.
ValueWithError RootOf(const PooledParameter& variance) {
  const double root = std::sqrt(std::max(0.0, variance.value));
  return {root, root > 0.0 ? variance.standard_error / (2.0 * root) : 0.0};
}

double FindCorrection(const CalibrationReport& report, CameraFault fault) {
  const auto found = std::ranges::find(report.faults, fault, &FaultReport::fault);
  return found == report.faults.end() ? 0.0 : found->correction;
}

// The faults that may exist: those of intrinsics and readout. A shift of image 2 is not an error of a camera
// and counts only if the test names it.
std::vector<CameraFault> ListUncertain(const CalibrationReport& report, const FaultEstimates& estimates) {
  std::vector<CameraFault> uncertain;
  for (const CameraFault fault : estimates.asked) {
    const bool is_shift = fault == CameraFault::kImage2ShiftX || fault == CameraFault::kImage2ShiftY;
    if (!is_shift || FindCorrection(report, fault) != 0.0) uncertain.push_back(fault);
  }
  return uncertain;
}

// Evidence on these faults with the others taken as zero. Standard deviations are those of a normal law with
// the estimates' intervals, since these come from few degrees of freedom.
std::optional<FaultEvidence> GatherEvidence(const CalibrationReport& report, const FaultEstimates& estimates,
                                            const std::vector<CameraFault>& faults) {
  const PooledScores pooled = PoolFaults(estimates.units, faults);
  const auto k = std::ssize(faults);
  if (std::ssize(pooled.parameters) != k || pooled.correlations.size() == 0) return std::nullopt;
  FaultEvidence evidence{Eigen::VectorXd(k), Eigen::MatrixXd(k, k), Eigen::VectorXd(k), Eigen::VectorXd(k)};
  Eigen::VectorXd sds(k);
  for (Eigen::Index j = 0; j < k; ++j) {
    const CameraFault fault = faults[static_cast<size_t>(j)];
    const PooledParameter& left = pooled.parameters[static_cast<size_t>(j)];
    evidence.estimates(j) = FindCorrection(report, fault) + left.value;
    sds(j) =
        0.5 * (left.interval.upper - left.interval.lower) / NormalQuantile(0.5 + 0.5 * kIntervalConfidence);
    evidence.nominal(j) = FindFaultText(fault).nominal;
    evidence.greatest(j) = GreatestFault(fault, estimates.camera);
  }
  evidence.covariance = sds.asDiagonal() * pooled.correlations * sds.asDiagonal();
  if (!evidence.estimates.allFinite() || !evidence.covariance.allFinite()) return std::nullopt;
  return evidence;
}

// Sets the corrections and the remaining uncertainty. Nothing is corrected if the residuals show a fault of
// another kind, which may only look like one of these.
void TakeUncertainty(const CalibrationReport& report, const FaultEstimates& estimates, CameraNoise* noise) {
  const std::vector<CameraFault> faults = ListUncertain(report, estimates);
  const std::optional<FaultEvidence> evidence = GatherEvidence(report, estimates, faults);
  const size_t n = noise->corrections.size();
  noise->uncertainty_correlations.assign(n * n, 0.0);
  for (size_t i = 0; i < n; ++i) noise->uncertainty_correlations[i * n + i] = 1.0;
  if (!evidence) return;
  const FaultPosterior posterior = InferFaults(*evidence);
  Eigen::VectorXd removed = ChooseRemoved(posterior);
  if (report.is_of_other_kind) removed.setZero();
  const Eigen::MatrixXd uncertainty = ComputeUncertainty(posterior, removed);
  const Eigen::VectorXd roots = uncertainty.diagonal().cwiseSqrt();
  const auto place = [&](CameraFault fault) {
    const auto found =
        std::ranges::find(noise->corrections, static_cast<size_t>(fault), &CameraCorrection::fault);
    return static_cast<size_t>(found - noise->corrections.begin());
  };
  for (Eigen::Index a = 0; a < roots.size(); ++a) {
    const size_t at = place(faults[static_cast<size_t>(a)]);
    noise->corrections[at].removed = removed(a);
    noise->corrections[at].uncertainty = roots(a);
    for (Eigen::Index b = 0; b < roots.size(); ++b)
      noise->uncertainty_correlations[at * n + place(faults[static_cast<size_t>(b)])] =
          uncertainty(a, b) / (roots(a) * roots(b));
  }
}

// Sets the joint estimates of all faults from pairs that are corrected for the named ones.
void TakeFaults(const CalibrationReport& report, const std::vector<PairAnswers>& corrected,
                CameraNoise* noise) {
  const FaultEstimates estimates = EstimateFaults(corrected);
  const PooledScores pooled = PoolFaults(estimates.units, estimates.asked);
  if (pooled.parameters.empty() || pooled.correlations.size() == 0) return;
  for (size_t j = 0; j < estimates.asked.size(); ++j) {
    const PooledParameter& left = pooled.parameters[j];
    noise->corrections.push_back(
        {static_cast<size_t>(estimates.asked[j]),
         {FindCorrection(report, estimates.asked[j]) + left.value, left.standard_error}});
  }
  const bool are_known = std::ranges::all_of(noise->corrections, [](const CameraCorrection& each) {
    return std::isfinite(each.estimate.value) && std::isfinite(each.estimate.standard_error);
  });
  if (!are_known) return noise->corrections.clear();
  noise->correlations.assign(pooled.correlations.data(),
                             pooled.correlations.data() + pooled.correlations.size());
  TakeUncertainty(report, estimates, noise);
}

// The report, with the corrections of a noise file in place of those of the named faults.
CalibrationReport TakeRemoved(CalibrationReport report, const CameraNoise& noise) {
  for (FaultReport& each : report.faults) {
    const auto found =
        std::ranges::find(noise.corrections, static_cast<size_t>(each.fault), &CameraCorrection::fault);
    each.correction = found == noise.corrections.end() ? 0.0 : found->removed;
  }
  return report;
}

// Uses residuals that are not divided by a power of the size, of matches that were selected with the
// division.
std::vector<SigmaOfSize> PoolSizes(const std::vector<FittedPair>& pairs) {
  std::vector<SigmaOfSize> sizes;
  for (size_t k = 0; k + 1 < std::size(kSizeEdges); ++k) {
    SigmaOfSize of{kSizeEdges[k], kSizeEdges[k + 1], {}, 0};
    std::vector<UnitScore> units;
    for (const FittedPair& pair : pairs) {
      double squares = 0.0, left = 0.0;
      for (size_t i = 0; i < pair.sizes.size(); ++i) {
        if (pair.sizes[i] < of.from || pair.sizes[i] >= of.to) continue;
        const double r = pair.scores.residuals[i] * pair.scales[i];
        squares += r * r;
        left += 1.0 - pair.leverages[i];
        ++of.num_matches;
      }
      if (left > 0.0)
        units.push_back({pair.images.image1, pair.images.image2, Eigen::VectorXd::Constant(1, squares),
                         Eigen::MatrixXd::Constant(1, 1, left)});
    }
    of.variance = PoolScoreAlone(units, 0, 0.95);
    if (of.num_matches > 0) sizes.push_back(of);
  }
  return sizes;
}

// The sum of two variances whose estimates are nearly independent.
PooledParameter AddVariances(const PooledParameter& a, const PooledParameter& b) {
  const double half = std::hypot(0.5 * (a.interval.upper - a.interval.lower),
                                 0.5 * (b.interval.upper - b.interval.lower)),
               value = a.value + b.value;
  return {value,
          std::hypot(a.standard_error, b.standard_error),
          {value - half, value + half},
          std::min(a.effective_n, b.effective_n)};
}

void TakeNoise(const std::vector<PairAnswers>& answers, NoiseCalibration* calibration) {
  calibration->size_exponent = FitSizeExponent(answers);
  const double exponent = calibration->size_exponent.value;
  const std::vector<FittedPair> pairs = FitPairs(answers, std::isfinite(exponent) ? exponent : 0.0);
  if (pairs.size() < kLeastPairsOfCamera)
    throw InputError(fmt::format("calibrate-noise: only {} pairs have 20 matches that agree; it takes {}",
                                 pairs.size(), kLeastPairsOfCamera));
  CameraNoise& noise = calibration->noise;
  noise.num_pairs = static_cast<int>(pairs.size());
  for (const FittedPair& pair : pairs) noise.num_matches += std::ssize(pair.scores.residuals);
  calibration->sizes = PoolSizes(pairs);
  const SharedVariance& shared = calibration->shared = FitSharedVariance(pairs);
  calibration->variance = shared.own;
  if (shared.is_key_point_found) {
    noise.key_point_px = std::sqrt(shared.key_point.value);
    calibration->variance = AddVariances(calibration->variance, shared.key_point);
  }
  if (shared.is_found) {
    noise.displacement_px = RootOf(shared.field.variance);
    noise.reach_px = shared.field.reach_px;
    noise.reach_factor = shared.reach_factor;
    calibration->variance = AddVariances(calibration->variance, shared.field.variance);
  }
  noise.sigma_px = RootOf(calibration->variance);
  noise.unseen_px = std::min(noise.sigma_px.value, std::sqrt(shared.unseen.variance.value));
  noise.unseen_reach_px = shared.unseen.reach_px;
  noise.size_exponent = {exponent, calibration->size_exponent.standard_error};
  noise.effective_pairs = shared.own.effective_n;
}

// Median over the pairs; NaN if no pair states a time.
double FindSecondsBetween(const std::vector<PairAnswers>& answers) {
  std::vector<double> seconds;
  for (const PairAnswers& each : answers) {
    if (std::isfinite(each.whole.pair.seconds_between)) seconds.push_back(each.whole.pair.seconds_between);
  }
  return ComputeMedian(std::move(seconds));
}

// Tests for a displacement that all images share. If it is found, the pairs are corrected for it and
// estimated again.
void TakeSystematic(const PairSet& set, const MotionEstimator& estimator, std::uint64_t seed,
                    std::vector<PairAnswers>* answers, NoiseCalibration* calibration) {
  const MotionProblem& first = set.pairs.front().problem;
  calibration->systematic = FitSystematicDisplacement(FitPairs(*answers, 0.0), first.camera1, seed);
  if (!(calibration->systematic.p_value < kSystematicLevel) || calibration->systematic.columns == 0) return;
  calibration->noise.systematic = calibration->systematic;
  CameraNoise displacement;  // alone: the faults are removed
  displacement.systematic = calibration->systematic;
  displacement.camera = first.camera1;
  displacement.sigma_px.value = first.sigma_px;
  *answers = AnswerAll(ApplyNoiseTo(set, displacement, estimator, seed), estimator, seed);
}

}  // namespace

NoiseCalibration CalibrateNoise(const PairSet& set, const MotionEstimator& estimator,
                                const std::string& estimator_name, std::uint64_t seed) {
  NoiseCalibration calibration;
  const PairSet of_camera = SelectCamera(set);
  calibration.num_given = static_cast<int>(set.pairs.size());
  calibration.num_other_cameras = static_cast<int>(set.pairs.size() - of_camera.pairs.size());
  std::vector<PairAnswers> answers = AnswerAll(of_camera, estimator, seed);
  calibration.num_unanswered = static_cast<int>(of_camera.pairs.size() - answers.size());
  if (answers.size() < kLeastPairsOfCamera)
    throw InputError(fmt::format(
        "calibrate-noise: {} of {} pairs have both images of the first pair's first camera, and {} of "
        "these have a motion; it takes {}{}",
        of_camera.pairs.size(), set.pairs.size(), answers.size(), kLeastPairsOfCamera,
        of_camera.pairs.empty() ? " (a stereo rig has two cameras, and none of its pairs is of one)"
                                : " (--scene picks pairs)"));
  CameraNoise& noise = calibration.noise;
  noise.estimator = estimator_name;
  noise.camera = of_camera.pairs.front().problem.camera1;
  noise.seconds_between = FindSecondsBetween(answers);
  calibration.faults = Calibrate(answers, estimator, seed);
  PairSet corrected = of_camera;
  if (NamesFault(calibration.faults)) {
    corrected = CorrectPairs(of_camera, calibration.faults, estimator, seed);
    answers = AnswerAll(corrected, estimator, seed);
  }
  TakeFaults(calibration.faults, answers, &noise);
  const auto removes = [](const CameraCorrection& each) { return each.removed != 0.0; };
  if (NamesFault(calibration.faults) || std::ranges::any_of(noise.corrections, removes)) {
    corrected = CorrectPairs(of_camera, TakeRemoved(calibration.faults, noise), estimator, seed);
    answers = AnswerAll(corrected, estimator, seed);
  }
  TakeSystematic(corrected, estimator, seed, &answers, &calibration);
  TakeNoise(answers, &calibration);
  return calibration;
}

}  // namespace rcme
