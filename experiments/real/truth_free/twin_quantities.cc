#include "experiments/real/truth_free/twin_quantities.h"

#include <cmath>
#include <optional>
#include <utility>

#include "estimator/geometry/sampson.h"
#include "estimator/noise_scale.h"
#include "experiments/real/truth_free/halves.h"
#include "experiments/real/truth_free/residual_pattern.h"
#include "experiments/real/truth_free/twin.h"
#include "experiments/real/truth_free/twin_source.h"
#include "experiments/trial/trial.h"
#include "stats/constants.h"
#include "stats/distributions.h"

namespace rcme {

const std::array<QuantityText, kNumQuantities> kQuantityTexts = {{
    {"refusal", true, false, "no motion, of all pairs",
     "scenes near what the estimator refuses: planes, little parallax"},
    {"failure", true, false, "motion beyond 3 deg or 15 deg, of pairs whose motion is known",
     "wrong matches that agree with each other, or a given truth that is wrong"},
    {"stated_failure", false, false, "stated probability of failure, mean",
     "wrong matches that agree with each other"},
    {"sigma_px", false, true, "noise estimated from the residuals (px), mean",
     "noise that differs from pair to pair"},
    {"accepted_share", false, true, "matches accepted, of all, mean",
     "wrong matches near the epipolar lines"},
    {"inlier_test", false, false,
     "accepted matches over those within 4 estimated sigma of their epipolar lines, mean",
     "tails of the noise, or matches with noise of their own (key-point size)"},
    {"tail_share", false, true, "accepted residuals beyond 2 estimated sigma, mean", "tails of the noise"},
    {"rotation_sd_deg", false, false, "stated standard deviation of the rotation (deg), geometric mean",
     "noise that differs from pair to pair"},
    {"direction_sd_deg", false, false, "stated standard deviation of the direction (deg), geometric mean",
     "noise that differs from pair to pair"},
    {"spatial_halves", true, false,
     "left/right and upper/lower halves within the 95 % region of their difference",
     "errors common to a part of the image: calibration, distortion, rolling shutter, texture"},
    {"random_halves", true, false, "random halves within the 95 % region of their difference",
     "wrong matches among the accepted, several motions"},
    {"near_correlation", false, true, "correlation of residuals up to 1 px apart, mean",
     "points that were found twice"},
    {"far_correlation", false, true, "correlation of residuals 4 to 16 px apart, mean",
     "errors common to neighbours: texture, distortion"},
}};

namespace {

constexpr double kLeastProductsOfPair = 20.0;  // of residuals, for the correlation of a pair
constexpr double kTailSigmas = 2.0;

void AddHalves(const MotionProblem& problem, const MotionEstimate& whole, const MotionEstimator& estimator,
               StreamName name, Values* values) {
  static const double bound = ChiSquareQuantile(5, 0.95);
  const auto add = [&](Split split, TwinQuantity quantity) {
    ++name.trial;
    const std::optional<double> difference = DifferenceOfHalves(problem, whole, split, estimator, name);
    if (difference) (*values)[quantity].push_back(*difference <= bound);
  };
  for (const Split split : kSpatialSplits) add(split, kSpatialHalves);
  for (const Split split : kRandomSplits) add(split, kRandomHalves);
}

void AddResiduals(const MotionProblem& problem, const MotionEstimate& estimate, Values* values) {
  const Eigen::Matrix3d F = ComputeFundamental(problem, estimate.cam2_from_cam1);
  const double sigma_px = EstimateNoise(problem, estimate);
  (*values)[kSigma].push_back(sigma_px);
  const auto is_within = [&](double bound, size_t i) {
    const double own_px = sigma_px * NoiseScaleAt(problem, i);
    return SquaredSampsonDistance(F, problem.matches[i]) <= bound * own_px * bound * own_px;
  };
  double num_beyond = 0.0, num_near = 0.0;
  for (const int i : estimate.inliers) num_beyond += !is_within(kTailSigmas, static_cast<size_t>(i));
  for (size_t i = 0; i < problem.matches.size(); ++i) num_near += is_within(kRightWithin, i);
  const double num_inliers = static_cast<double>(estimate.inliers.size());
  if (num_near > 0.0) (*values)[kInlierTest].push_back(num_inliers / num_near);
  (*values)[kTailShare].push_back(num_beyond / num_inliers);
  (*values)[kAcceptedShare].push_back(num_inliers / static_cast<double>(problem.matches.size()));
  const ResidualProducts products = SumProducts(problem, estimate);
  for (const auto& [quantity, distance] :
       {std::pair{kNearCorrelation, size_t{0}}, {kFarCorrelation, size_t{2}}}) {
    if (products.counts[distance] >= kLeastProductsOfPair)
      (*values)[quantity].push_back(products.Correlation(distance));
  }
}

}  // namespace

Values ComputeValues(const TrialData& trial, const MotionEstimate& estimate, const MotionEstimator& estimator,
                     const StreamName& name) {
  Values values;
  const TrialRecord record = Score(estimate, trial, 0.0);
  values[kRefusal].push_back(HasRefused(record));
  if (trial.truth.cam2_from_cam1_true) values[kFailure].push_back(HasFailed(record, FailureBounds()));
  if (estimate.status != MotionStatus::kOk || estimate.inliers.empty()) return values;
  if (std::isfinite(estimate.failure_probability))
    values[kStatedFailure].push_back(estimate.failure_probability);
  AddResiduals(trial.problem, estimate, &values);
  const Vector5d variances = estimate.pose_cov.diagonal();
  values[kRotationSd].push_back(std::log(kDegPerRad * std::sqrt(variances.head<3>().sum())));
  values[kDirectionSd].push_back(std::log(kDegPerRad * std::sqrt(variances.tail<2>().sum())));
  AddHalves(trial.problem, estimate, estimator, name, &values);
  return values;
}

}  // namespace rcme
