#include "estimator/estimators/rcme_calibrated.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "estimator/calibrated/candidates.h"
#include "estimator/calibrated/checked_probability.h"
#include "estimator/calibrated/describe_answer.h"
#include "estimator/calibrated/explain_matches.h"
#include "estimator/calibrated/failure_probability.h"
#include "estimator/calibrated/judge_modes.h"
#include "estimator/calibrated/mode_covariance.h"
#include "estimator/calibrated/modes_verdict.h"
#include "estimator/calibrated/noise_choice.h"
#include "estimator/calibrated/noise_shape.h"
#include "estimator/calibrated/prior_check.h"
#include "estimator/calibrated/second_motion.h"
#include "estimator/calibrated/settle_direction.h"
#include "estimator/calibrated/split_mode.h"
#include "estimator/calibrated/upright_search.h"
#include "estimator/calibrated/weigh_modes.h"
#include "estimator/calibrated/whitened_problem.h"
#include "estimator/noise_scale.h"
#include "estimator/problem_check.h"
#include "estimator/robust_covariance/covariance_option.h"
#include "parameters/probability_text.h"

namespace rcme {
namespace {

constexpr double kNotableWeight = 1e-4;  // modes below this weight are not reported

// The problem with its matches in random order; (*order)[i] is the original index of match i.
MotionProblem Shuffled(const MotionProblem& problem, RandomStream& rng, std::vector<int>* order) {
  order->resize(problem.matches.size());
  std::iota(order->begin(), order->end(), 0);
  rng.Shuffle(std::span<int>(*order));
  return SelectPart(problem, *order);
}

MixturePrior MakePrior(const MotionProblem& problem, const CalibratedOptions& options) {
  const double diagonal = std::hypot(problem.camera2.width, problem.camera2.height) / problem.sigma_px;
  return {2.0 / diagonal, options.sigma == SigmaKnowledge::kEstimated,
          problem.prior ? &*problem.prior : nullptr};
}

// The intermediate results of an estimate.
struct Workings {
  MotionProblem problem;  // its matches in the order that the modes use
  std::vector<ExplainedMode> modes;
  ModeWeights weights;
  std::optional<WeakDirection> weak_direction;
  CheckedVerdict checked;
};

// Adds the optimum reached from a mode, unless it is in the list.
void AddOptimumFrom(Mode mode, const MatchBlocks& matches, const MixturePrior& prior,
                    std::vector<ExplainedMode>* modes) {
  constexpr int kSteps = 20;
  if (!FitMode(matches, prior, kSteps, &mode)) return;
  const bool is_known = std::ranges::any_of(
      *modes, [&](const ExplainedMode& known) { return IsSameMode(known.mode, mode, 1.0); });
  if (!is_known) modes->push_back({mode, Explain(matches, mode)});
}

// The covariance of a motion whose direction may be in any of these cells: the second moment of the rotation
// about the centre, and pi^2 I for the direction, of which nothing is known.
Matrix5d SpreadOverCells(const std::vector<DirectionCell>& cells) {
  Matrix5d spread = Matrix5d::Zero();
  for (const DirectionCell& cell : cells)
    spread.topLeftCorner<3, 3>() +=
        cell.weight * (cell.rotation_cov + cell.rotation * cell.rotation.transpose());
  spread.bottomRightCorner<2, 2>() = std::numbers::pi * std::numbers::pi * Eigen::Matrix2d::Identity();
  return spread;
}

// The sandwich covariance of a mode from the matches alone, without the prior.
Matrix5d OwnCovarianceOfMatches(const MatchBlocks& matches, const MixturePrior& prior, Mode mode) {
  mode.hessian = FindMatchInformation(prior.motion, mode);
  mode.inverse_hessian = mode.hessian.inverse();
  return SandwichCovariance(mode, Explain(matches, mode), InverseOfObserved(matches, mode));
}

void FillMotion(const ExplainedMode& answer, const ModesVerdict& verdict, double assumed_sigma_px,
                MotionEstimate* estimate) {
  const MixtureParameters& mixture = answer.mode.mixture;
  estimate->status = MotionStatus::kOk;
  estimate->cam2_from_cam1 = estimate->initial_pose = answer.mode.pose;
  estimate->pose_cov = verdict.pose_cov.mixed;
  estimate->pose_cov_without_errors = verdict.pose_cov.exact;
  estimate->pose_cov_with_errors = verdict.pose_cov.with_errors;
  estimate->failure_probability = verdict.failure_probability;
  estimate->calibration_error_probability = verdict.unstated_errors.probability;
  estimate->sigma_estimated_px = assumed_sigma_px * mixture.scale / mixture.noise.scale_of_gaussian;
}

// `order` is that of Shuffled.
void FillMatches(const Explanation& explanation, const std::vector<int>& order, MotionEstimate* estimate) {
  estimate->inlier_probabilities.resize(order.size());
  double num_right = 0.0;
  for (size_t i = 0; i < order.size(); ++i) {
    const double p = explanation.probability[i];
    num_right += p;
    estimate->inlier_probabilities[static_cast<size_t>(order[i])] = p;
  }
  for (size_t i = 0; i < order.size(); ++i) {
    if (estimate->inlier_probabilities[i] > 0.5) estimate->inliers.push_back(static_cast<int>(i));
  }
  estimate->num_support = estimate->num_explained = static_cast<int>(estimate->inliers.size());
  // A variance estimated with k degrees of freedom has variance 2 sigma^4 / k.
  const double freedom = std::max(num_right - 5.0, 1.0);
  estimate->sigma_estimated_sd_px = estimate->sigma_estimated_px / std::sqrt(2.0 * freedom);
}

void FillOtherModes(const std::vector<ExplainedMode>& modes, const ModeWeights& weights,
                    MotionEstimate* estimate) {
  const Explanation& answer = modes[weights.answer].explanation;
  for (size_t i = 0; i < modes.size(); ++i) {
    if (i == weights.answer || weights.of_modes[i] < kNotableWeight) continue;
    const Explanation& other = modes[i].explanation;
    int num_only = 0;
    for (size_t k = 0; k < answer.probability.size(); ++k) {
      num_only += other.probability[k] > 0.5 && !(answer.probability[k] > 0.5);
    }
    estimate->other_modes.push_back({modes[i].mode.pose, BoundByUniformMotion(modes[i].mode.inverse_hessian),
                                     weights.of_modes[i],
                                     num_only / static_cast<double>(answer.probability.size())});
  }
  std::ranges::stable_sort(estimate->other_modes, std::ranges::greater{}, &MotionMode::weight);
}

class RcmeCalibrated : public MotionEstimator, public WeightInspection {
 public:
  explicit RcmeCalibrated(const CalibratedOptions& options) : options_(options) { Validate(options); }

  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    Workings workings;
    return EstimateAndTell(problem, rng, &workings, nullptr);
  }

  MotionEstimate EstimateChecked(const MotionProblem& problem, RandomStream& rng,
                                 CheckedVerdict* checked) const override {
    Workings workings;
    workings.checked = *checked;
    MotionEstimate estimate = EstimateAndTell(problem, rng, &workings, nullptr);
    *checked = workings.checked;
    return estimate;
  }

  MotionEstimate EstimateWithPosterior(const MotionProblem& problem, RandomStream& rng,
                                       std::optional<MotionPosterior>* posterior) const override {
    posterior->reset();
    Workings workings;
    return EstimateAndTell(problem, rng, &workings, posterior);
  }

  std::vector<ExplainedMode> ListModes(const MotionProblem& problem, RandomStream& rng) const override {
    if (RefuseUnsolvable(problem, 6)) return {};
    std::vector<int> order;
    const MotionProblem shuffled = Shuffled(problem, rng, &order);
    LoopCounts counts;
    return FindExplained(shuffled, MatchBlocks(shuffled), MakePrior(problem, options_), rng, &counts);
  }

  std::vector<WeighedMotion> WeighMotions(const MotionProblem& problem,
                                          const std::vector<RelativePose>& starts) const override {
    if (RefuseUnsolvable(problem, 6)) return {};
    const MatchBlocks matches(problem);
    const MixturePrior prior = MakePrior(problem, options_);
    const std::vector<ExplainedMode> modes =
        ExplainMatches(problem, matches, prior, options_, ModesFrom(matches, prior, starts));
    if (modes.empty()) return {};
    const ModeWeights weights = WeighModes(modes, Bounds(), prior, options_);
    std::vector<WeighedMotion> weighed;
    for (size_t i = 0; i < modes.size(); ++i) {
      weighed.push_back(
          {modes[i].mode.pose, weights.of_modes[i], modes[i].explanation.num_explained, i == weights.answer});
    }
    return weighed;
  }

 private:
  // Estimate. If the residuals show that the noise is anisotropic, again in coordinates in which it is not.
  // `workings` receives the intermediate results; `posterior` may be null.
  MotionEstimate EstimateAndTell(const MotionProblem& problem, RandomStream& rng, Workings* workings,
                                 std::optional<MotionPosterior>* posterior) const {
    RandomStream same = rng;
    MotionEstimate estimate = EstimateWithPrior(problem, rng, workings, posterior);
    const std::optional<NoiseShape> shape = FindNoiseShape(*workings);
    if (!shape) return estimate;
    const WhitenedProblem whitened(problem, shape->Covariance());
    Workings second;
    std::optional<MotionPosterior> second_posterior;
    MotionEstimate again = MakeForPixels(whitened).EstimateWithPrior(
        whitened.problem(), same, &second, posterior != nullptr ? &second_posterior : nullptr);
    if (second.modes.empty()) return estimate;
    whitened.Restore(&again);
    *workings = std::move(second);
    if (second_posterior) {
      whitened.Restore(&*second_posterior);
      *posterior = std::move(second_posterior);
    }
    return again;
  }

  // The same estimator, with the uncertainty of the principal points in the whitened problem's pixels.
  RcmeCalibrated MakeForPixels(const WhitenedProblem& whitened) const {
    CalibratedOptions options = options_;
    options.calibration.of_pixels1 = whitened.of_pixels1();
    options.calibration.of_pixels2 = whitened.of_pixels2();
    return RcmeCalibrated(options);
  }

  // The shape of the noise about the answer, unless something else may be the reason for it.
  std::optional<NoiseShape> FindNoiseShape(const Workings& workings) const {
    if (options_.leave_out == CalibratedStep::kNoiseShape || workings.modes.empty()) return std::nullopt;
    const std::optional<NoiseShape> shape =
        FitNoiseShape(workings.problem, workings.modes[workings.weights.answer]);
    return shape && IsNoiseAnisotropic(*shape, workings.checked.check) ? shape : std::nullopt;
  }

  // Estimate in the given coordinates. Leaves out a prior that the matches contradict (prior_check.h).
  MotionEstimate EstimateWithPrior(const MotionProblem& problem, RandomStream& rng, Workings* workings,
                                   std::optional<MotionPosterior>* posterior) const {
    if (!problem.prior || RefuseUnsolvable(problem, 6))
      return EstimateOnce(problem, rng, workings, posterior);
    MotionProblem without = problem;
    without.prior.reset();
    RandomStream same = rng;
    Workings of_matches, of_both;
    std::optional<MotionPosterior> posterior_of_matches;
    std::optional<MotionPosterior>* const wanted = posterior != nullptr ? &posterior_of_matches : nullptr;
    MotionEstimate alone = EstimateOnce(without, same, &of_matches, wanted);
    MotionEstimate estimate = EstimateOnce(problem, rng, &of_both, posterior);
    const double p_value = ComputePriorPValue(*problem.prior, ListBeliefs(of_matches, of_both));
    const bool is_contradicted = p_value < kPriorLevel;
    if (is_contradicted) {
      estimate = std::move(alone);
      const double agreement = ComputePriorAgreement(*problem.prior);
      estimate.message +=
          agreement < kPriorLevel
              ? fmt::format(
                    "; the prior's rotation and gravity contradict each other (probability {}); "
                    "neither is used",
                    ProbabilityText(agreement))
              : fmt::format("; the prior contradicts the matches (probability {}) and is not used",
                            ProbabilityText(p_value));
      if (posterior != nullptr) *posterior = std::move(posterior_of_matches);
    }
    estimate.prior = is_contradicted ? PriorUse::kContradicted : PriorUse::kUsed;
    estimate.prior_p_value = p_value;
    *workings = std::move(is_contradicted ? of_matches : of_both);
    return estimate;
  }

  // The motions that are possible from the matches alone: those found without the prior, and the optimum of
  // the matches near the answer with the prior, which the search without it may have missed.
  std::vector<MotionBelief> ListBeliefs(const Workings& of_matches, const Workings& of_both) const {
    const MotionProblem& problem = of_matches.problem;
    const MatchBlocks matches(problem);
    const MixturePrior prior = MakePrior(problem, options_);
    std::vector<ExplainedMode> modes = of_matches.modes;
    if (!of_both.modes.empty())
      AddOptimumFrom(of_both.modes[of_both.weights.answer].mode, matches, prior, &modes);
    if (modes.empty()) return {};
    const ModeWeights weights = WeighModes(modes, Bounds(), prior, options_);
    std::vector<MotionBelief> beliefs;
    for (size_t i = 0; i < modes.size(); ++i) {
      if (!(weights.of_modes[i] >= kNegligibleWeight)) continue;
      const Matrix5d curvature = InverseOfObserved(matches, modes[i].mode);
      Matrix5d covariance = ComputeModeCovariance(
          modes[i], curvature, IntrinsicsCovariance(problem, options_.calibration, modes[i].mode, curvature),
          of_matches.checked.check, prior, options_);
      if (of_matches.weak_direction && !weights.is_second_motion[i])
        covariance = SpreadOverCells(ComputeDirectionCells(problem, modes[i], Bounds().direction_rad));
      else if (options_.covariance != CovarianceKind::kRobust)
        covariance = BoundByUniformMotion(covariance);
      beliefs.push_back({modes[i].mode.pose, covariance, weights.of_modes[i],
                         FindUnstatedErrors(problem, modes[i].mode, modes[i].explanation, options_)});
    }
    return beliefs;
  }

  // Estimate from the matches and the problem's prior, unchecked.
  MotionEstimate EstimateOnce(const MotionProblem& problem, RandomStream& rng, Workings* workings,
                              std::optional<MotionPosterior>* posterior) const {
    if (std::optional<MotionEstimate> refusal = RefuseUnsolvable(problem, 6)) return *refusal;
    std::vector<int> order;
    MotionProblem shuffled = Shuffled(problem, rng, &order);
    const MatchBlocks matches(shuffled);
    const MixturePrior prior = MakePrior(shuffled, options_);
    MotionEstimate estimate;
    std::vector<ExplainedMode> modes = FindExplained(shuffled, matches, prior, rng, &estimate.counts);
    const int num_solved = estimate.counts.num_hypotheses - estimate.counts.num_degenerate_samples;
    estimate.counts.num_candidates = std::min(static_cast<int>(modes.size()), num_solved);
    estimate.counts.num_too_small_inlier_sets = num_solved - estimate.counts.num_candidates;
    if (modes.empty()) {
      estimate.status = MotionStatus::kNoCandidate;
      estimate.message = "no motion explains more than five matches";
      workings->problem = std::move(shuffled);
      return estimate;
    }
    ModeWeights weights = WeighModes(modes, Bounds(), prior, options_);
    if (options_.leave_out != CalibratedStep::kNoiseChoice)
      ChooseNoiseLaw(matches, prior, &modes[weights.answer]);
    std::optional<WeakDirection> weak_direction;
    if (options_.leave_out != CalibratedStep::kDirectionPosterior) {
      weak_direction = SettleDirection(shuffled, matches, prior, Bounds().direction_rad, options_.leave_out,
                                       &modes[weights.answer]);
      weights = WithoutCopies(modes, std::move(weights));
      weights.is_rival = FindRivals(modes, weights.answer, Bounds());
    }
    const bool is_checked = options_.leave_out != CalibratedStep::kModelCheck;
    const ModelCheck check = CheckModel(shuffled, modes, weights);
    std::vector<ModeSpread> spreads;
    ModesVerdict verdict =
        JudgeModes({shuffled, matches, prior, modes, weights, weak_direction, check, options_}, rng,
                   posterior != nullptr ? &spreads : nullptr);
    workings->checked = {check, verdict.by_modes};
    if (is_checked) verdict.failure_probability = CheckedFailureProbability(verdict.by_modes, check);
    verdict.failure_probability += (1.0 - verdict.left_by_intrinsics) * (1.0 - verdict.failure_probability);
    if (is_checked) estimate.probability_domain = Domain(verdict.by_modes, check, prior);
    FillMotion(modes[weights.answer], verdict, problem.sigma_px, &estimate);
    FillMatches(modes[weights.answer].explanation, order, &estimate);
    const ModeWeights reweighed = ReweighModes(weights, verdict);
    FillOtherModes(modes, reweighed, &estimate);
    estimate.doubt = FindDoubt(modes, weights, verdict);
    estimate.message = DescribeAnswer(estimate, InImagePixels(problem, estimate.sigma_estimated_px), check);
    if (estimate.failure_probability > options_.max_failure_probability) {
      estimate.status = MotionStatus::kTooUncertain;
    } else if (options_.covariance == CovarianceKind::kRobust) {
      RobustCovarianceOptions robust = options_.robust;
      robust.calibration = options_.calibration;
      robust.factor = 1.0;  // below, of the greater of both
      const Mode& answer = modes[weights.answer].mode;
      const Matrix5d own =
          prior.motion ? OwnCovarianceOfMatches(matches, prior, answer) : verdict.pose_cov.exact;
      MakeCovarianceRobust(problem, robust, own, &estimate);
      if (estimate.status == MotionStatus::kOk) {
        // No smaller than the checked one, on average over the directions.
        const double ratio =
            is_checked ? estimate.pose_cov.llt().solve(CovarianceFactor(check) * own).trace() / 5.0 : 1.0;
        const double factor = options_.robust.factor;
        const Matrix5d of_matches =
            factor * (ratio > 1.0 && std::isfinite(ratio) ? ratio : 1.0) * estimate.pose_cov;
        UnstatedErrors errors = verdict.unstated_errors;
        errors.shift *= std::sqrt(factor);
        errors.spread *= factor;
        const Matrix5d of_both = CovarianceWithPrior(of_matches, answer, prior);
        estimate.pose_cov_without_errors = BoundByUniformMotion(of_both);
        estimate.pose_cov_with_errors = errors.AddTo(of_both);
        MixErrors(&estimate);
      }
    }
    if (posterior != nullptr)
      *posterior = BuildPosterior(shuffled, modes, reweighed, spreads, weak_direction.has_value(), estimate);
    workings->weights = std::move(weights);
    workings->weak_direction = weak_direction;
    workings->modes = std::move(modes);
    workings->problem = std::move(shuffled);
    return estimate;
  }

  MotionBounds Bounds() const { return MakeMotionBounds(options_); }

  // Steps 1 to 4.
  std::vector<ExplainedMode> FindExplained(const MotionProblem& problem, const MatchBlocks& matches,
                                           const MixturePrior& prior, RandomStream& rng,
                                           LoopCounts* counts) const {
    const ScoreMatches score_matches(matches);
    HypothesisSearch search =
        SearchHypotheses(matches, score_matches, options_, rng, kSoftScale, prior.motion);
    AddUprightCandidates(matches, score_matches, prior, search.num_samples / 4,
                         static_cast<size_t>((options_.num_candidates + 1) / 2), rng, &search);
    *counts = search.counts;
    std::vector<Mode> found =
        FindModes(matches, prior, search.candidates, static_cast<size_t>(options_.num_modes));
    if (options_.leave_out != CalibratedStep::kSplit) SplitCompromise(problem, matches, prior, &found, rng);
    if (options_.leave_out != CalibratedStep::kSecondMotion)
      AddSecondMotion(problem, matches, prior, &found, rng);
    return ExplainMatches(problem, matches, prior, options_, std::move(found));
  }

  // The constants of the check were fitted to the default options, without priors.
  ProbabilityDomain Domain(double by_modes, const ModelCheck& check, const MixturePrior& prior) const {
    const CalibratedOptions usual;
    const bool is_usual = options_.max_rotation_error_deg == usual.max_rotation_error_deg &&
                          options_.max_direction_error_deg == usual.max_direction_error_deg &&
                          options_.num_modes == usual.num_modes && options_.sigma == usual.sigma &&
                          options_.second_motion_odds == usual.second_motion_odds &&
                          options_.leave_out == usual.leave_out && prior.motion == nullptr;
    return is_usual && IsInDomain(by_modes, check) ? ProbabilityDomain::kVerified
                                                   : ProbabilityDomain::kExtrapolated;
  }

  // `spreads` of each mode: see Judge. With CovarianceKind::kRobust the covariance is not computed per mode:
  // the estimate's is used for the whole answer.
  MotionPosterior BuildPosterior(const MotionProblem& problem, const std::vector<ExplainedMode>& modes,
                                 const ModeWeights& weights, const std::vector<ModeSpread>& spreads,
                                 bool is_direction_weak, const MotionEstimate& estimate) const {
    const bool is_whole = options_.covariance == CovarianceKind::kRobust;
    std::vector<MotionComponent> components;
    for (size_t i = 0; i < modes.size(); ++i) {
      const double weight = weights.of_modes[i];
      const bool is_answer = IsWithin(estimate.cam2_from_cam1, Bounds(), modes[i].mode.pose);
      if (is_direction_weak && (is_answer || !weights.is_second_motion[i])) continue;
      if (weight < kNegligibleWeight && i != weights.answer) continue;
      if (is_whole && is_answer && i != weights.answer) continue;
      const bool is_of_estimate = is_whole && is_answer;
      const double of_errors = is_answer ? weight * estimate.calibration_error_probability : 0.0;
      components.push_back({modes[i].mode.pose,
                            is_of_estimate ? estimate.pose_cov_without_errors : spreads[i].exact,
                            weight - of_errors, is_answer});
      if (of_errors > 0.0)
        components.push_back({modes[i].mode.pose,
                              is_of_estimate ? estimate.pose_cov_with_errors : spreads[i].with_errors,
                              of_errors, true});
    }
    std::vector<DirectionCell> cells;
    if (is_direction_weak)
      cells = ComputeDirectionCells(problem, modes[weights.answer], Bounds().direction_rad);
    return MakeMotionPosterior(estimate.cam2_from_cam1, Bounds(), estimate.failure_probability,
                               std::move(components), std::move(cells));
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
