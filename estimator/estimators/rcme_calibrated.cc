#include "estimator/estimators/rcme_calibrated.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "estimator/calibrated/candidates.h"
#include "estimator/calibrated/explain_matches.h"
#include "estimator/calibrated/failure_probability.h"
#include "estimator/calibrated/mode_covariance.h"
#include "estimator/calibrated/weigh_modes.h"
#include "estimator/problem_check.h"

namespace rcme {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kNegligibleWeight = 1e-9;

// The matches in an order that means nothing: order[i] is the index of the i-th.
MotionProblem Shuffled(const MotionProblem& problem, RandomStream& rng, std::vector<int>* order) {
  order->resize(problem.matches.size());
  std::iota(order->begin(), order->end(), 0);
  rng.Shuffle(std::span<int>(*order));
  MotionProblem shuffled = problem;
  for (size_t i = 0; i < order->size(); ++i) {
    shuffled.matches[i] = problem.matches[static_cast<size_t>((*order)[i])];
  }
  return shuffled;
}

MixturePrior PriorOf(const MotionProblem& problem, const CalibratedOptions& options) {
  const double diagonal = std::hypot(problem.camera2.width, problem.camera2.height) / problem.sigma_px;
  return {2.0 / diagonal, options.sigma == SigmaKnowledge::kEstimated};
}

class RcmeCalibrated : public MotionEstimator {
 public:
  explicit RcmeCalibrated(const CalibratedOptions& options) : options_(options) { Validate(options); }

  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    if (std::optional<MotionEstimate> refusal = RefuseUnsolvable(problem, 6)) return *refusal;
    std::vector<int> order;
    const MotionProblem shuffled = Shuffled(problem, rng, &order);
    const MatchBlocks matches(shuffled);
    const ScoreMatches score_matches(matches);
    const MixturePrior prior = PriorOf(problem, options_);
    const HypothesisSearch search = SearchHypotheses(matches, score_matches, options_, rng);
    std::vector<Mode> modes =
        FindModes(matches, prior, search.candidates, static_cast<size_t>(options_.num_modes));
    MotionEstimate estimate;
    estimate.counts = search.counts;
    const std::vector<ExplainedMode> explained = ExplainMatches(shuffled, matches, prior, std::move(modes));
    if (explained.empty()) {
      estimate.status = MotionStatus::kNoCandidate;
      estimate.message = "no motion explains more than five matches";
      return estimate;
    }
    Answer(shuffled, matches, explained, prior, order, rng, &estimate);
    return estimate;
  }

 private:
  void Answer(const MotionProblem& problem, const MatchBlocks& matches,
              const std::vector<ExplainedMode>& modes, const MixturePrior& prior,
              const std::vector<int>& order, RandomStream& rng, MotionEstimate* estimate) const {
    const MotionBounds bounds{kRadPerDeg * options_.max_rotation_error_deg,
                              kRadPerDeg * options_.max_direction_error_deg};
    const ModeWeights weights = WeighModes(modes, bounds, prior, options_);
    const size_t answer = weights.answer;
    const RelativePose& pose = modes[answer].mode.pose;
    double success = 0.0, weight_within = 0.0;
    Matrix5d spread = Matrix5d::Zero();
    for (size_t i = 0; i < modes.size(); ++i) {
      if (weights.of_modes[i] < kNegligibleWeight) continue;
      const Matrix5d covariance = CovarianceOf(problem, matches, modes[i]);
      success += weights.of_modes[i] *
                 MassWithin(pose, bounds, modes[i].mode.pose, modes[i].mode.inverse_hessian, rng);
      if (!IsWithin(pose, bounds, modes[i].mode.pose)) continue;
      const Vector5d away = LocalCoordinates(pose, modes[i].mode.pose);
      spread += weights.of_modes[i] * (covariance + away * away.transpose());
      weight_within += weights.of_modes[i];
    }
    const Explanation& explanation = modes[answer].explanation;
    estimate->status = MotionStatus::kOk;
    estimate->cam2_from_cam1 = estimate->initial_pose = pose;
    estimate->pose_cov = spread / weight_within;
    estimate->failure_probability = std::clamp(1.0 - success, 0.0, 1.0);
    const MixtureParameters& mixture = modes[answer].mode.mixture;
    const double sigma = problem.sigma_px * mixture.scale / mixture.noise.scale_of_gaussian;
    estimate->sigma_estimated_px = sigma;
    estimate->inlier_probabilities.resize(order.size());
    double num_right = 0.0;
    for (size_t i = 0; i < order.size(); ++i) {
      const double p = explanation.probability[i];
      num_right += p;
      estimate->inlier_probabilities[static_cast<size_t>(order[i])] = p;
      if (p > 0.5) estimate->inliers.push_back(order[i]);
    }
    std::ranges::sort(estimate->inliers);
    estimate->sigma_estimated_sd_px = sigma / std::sqrt(2.0 * std::max(num_right - 5.0, 1.0));
    estimate->num_support = estimate->num_explained = static_cast<int>(estimate->inliers.size());
  }

  Matrix5d CovarianceOf(const MotionProblem& problem, const MatchBlocks& matches,
                        const ExplainedMode& mode) const {
    Matrix5d covariance = options_.covariance == CovarianceKind::kSandwich
                              ? SandwichCovariance(matches, mode.mode, mode.explanation)
                              : mode.mode.inverse_hessian;
    if (options_.focal_sd > 0.0 || options_.principal_point_sd_px > 0.0) {
      covariance += IntrinsicsCovariance(problem, options_, mode.mode);
    }
    return covariance;
  }

  CalibratedOptions options_;
};

class CalibratedModel : public EstimatorModel {
 public:
  std::vector<Parameter> Parameters() override { return rcme::Parameters(options_); }
  void LiftLimits() override { options_.max_failure_probability = 1.0; }
  std::optional<Effort> EffortOption() const override { return Effort{"max_samples", true}; }
  std::unique_ptr<MotionEstimator> Make() const override { return MakeRcmeCalibrated(options_); }

 private:
  CalibratedOptions options_;
};

}  // namespace

std::unique_ptr<MotionEstimator> MakeRcmeCalibrated(const CalibratedOptions& options) {
  return std::make_unique<RcmeCalibrated>(options);
}

std::unique_ptr<EstimatorModel> RcmeCalibratedModel() { return std::make_unique<CalibratedModel>(); }

}  // namespace rcme
