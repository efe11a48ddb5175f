#include "experiments/real/camera_noise/fitted_pairs.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "estimator/noise_scale.h"
#include "estimator/robust_covariance/robust_covariance.h"
#include "stats/constants.h"

namespace rcme {
namespace {

constexpr size_t kLeastAgreeing = 20;
constexpr double kLeastSizeSpread = 0.01;    // of log size^2, mean square
constexpr double kLeastLeverageKept = 0.05;  // 1 - h
constexpr int kMostSizeRounds = 8;
constexpr double kSmallSizeStep = 0.1;  // of a standard error
constexpr double kGreatestExponent = 4.0;
// Of a normal law's variance, what is left within its 99.9 %, |z| < 3.2905: 1 - 2 z phi(z) / 0.999.
constexpr double kVarianceLeft = 0.98829;

// The slope's score and information of one pair; false where sizes are none or all alike.
bool ScoreSizeSlope(const FittedPair& pair, UnitScore* unit) {
  if (pair.sizes.empty()) return false;
  std::vector<double> x, y;
  double mean_x = 0.0, spread = 0.0, sum = 0.0;
  for (size_t i = 0; i < pair.sizes.size(); ++i) {
    const double r = pair.scores.residuals[i];
    if (r == 0.0) continue;
    x.push_back(2.0 * std::log(pair.sizes[i]));
    y.push_back(std::log(r * r / std::max(1.0 - pair.leverages[i], kLeastLeverageKept)));
    mean_x += x.back();
  }
  mean_x /= static_cast<double>(x.size());
  for (size_t i = 0; i < x.size(); ++i) {
    spread += (x[i] - mean_x) * (x[i] - mean_x);
    sum += (x[i] - mean_x) * y[i];
  }
  *unit = {pair.images.image1, pair.images.image2, Eigen::VectorXd::Constant(1, sum),
           Eigen::MatrixXd::Constant(1, 1, spread)};
  return spread > kLeastSizeSpread * static_cast<double>(x.size());
}

}  // namespace

std::vector<FittedPair> FitPairs(const std::vector<PairAnswers>& answers, double exponent) {
  const std::vector<ImageNumbers> images = NumberImages(answers);
  std::vector<FittedPair> pairs;
  for (size_t k = 0; k < answers.size(); ++k) {
    const Answered& whole = answers[k].whole;
    if (!whole.IsOk() || whole.estimate.inliers.size() < kLeastAgreeing) continue;
    MotionProblem problem = whole.pair.problem;
    for (double& scale : problem.noise_scale) scale = std::pow(scale, exponent);
    const AgreeingFit fit = FitAgreeing(problem, whole.estimate.cam2_from_cam1, whole.estimate.inliers);
    if (fit.fitted.size() < kLeastAgreeing) continue;
    problem.sigma_px = 1.0;
    FittedPair pair{images[k], problem.camera1, ScoreFitted(problem, fit.fitted, fit.cam2_from_cam1), {}, {},
                    {}};
    const Eigen::LLT<Matrix5d> llt(pair.scores.information);
    if (llt.info() != Eigen::Success) continue;
    double sum = 0.0;
    for (double& r : pair.scores.residuals) r /= std::sqrt(kVarianceLeft);
    for (size_t i = 0; i < fit.fitted.size(); ++i) {
      if (!problem.noise_scale.empty())
        pair.sizes.push_back(whole.pair.problem.noise_scale[static_cast<size_t>(fit.fitted[i])]);
      pair.scales.push_back(NoiseScaleAt(problem, static_cast<size_t>(fit.fitted[i])));
      pair.leverages.push_back(pair.scores.rows[i].dot(llt.solve(pair.scores.rows[i])));
      sum += pair.scores.residuals[i] * pair.scores.residuals[i];
    }
    pair.variance = sum / static_cast<double>(fit.fitted.size() - 5);
    if (pair.variance > 0.0) pairs.push_back(std::move(pair));
  }
  return pairs;
}

PooledParameter FitSizeExponent(const std::vector<PairAnswers>& answers) {
  const bool has_sizes = std::ranges::any_of(
      answers, [](const PairAnswers& each) { return !each.whole.pair.problem.noise_scale.empty(); });
  PooledParameter slope{kNaN, kNaN, {-kInfinity, kInfinity}, 0.0};
  double exponent = 0.0;
  for (int round = 0; has_sizes && round < kMostSizeRounds; ++round) {
    std::vector<UnitScore> units;
    for (const FittedPair& pair : FitPairs(answers, exponent)) {
      UnitScore unit;
      if (ScoreSizeSlope(pair, &unit)) units.push_back(std::move(unit));
    }
    if (units.empty()) return slope;
    slope = PoolScoreAlone(units, 0, 0.95);
    const double step = slope.value;
    for (double* x : {&slope.value, &slope.interval.lower, &slope.interval.upper}) *x += exponent;
    exponent = std::clamp(exponent + step, -kGreatestExponent, kGreatestExponent);
    if (std::abs(step) <= kSmallSizeStep * slope.standard_error) break;
  }
  return slope;
}

}  // namespace rcme
