#include "experiments/real/answer/why.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "estimator/estimator_registry.h"
#include "estimator/estimators/rcme_calibrated.h"
#include "estimator/loop_inspection.h"
#include "estimator/motion_tests.h"
#include "estimator/reference_matches.h"
#include "experiments/core/text/pick_name.h"
#include "experiments/real/answer/estimate_output.h"
#include "experiments/real/answer/motion_words.h"
#include "experiments/study/estimator_spec.h"
#include "parameters/input_error.h"
#include "stats/constants.h"

namespace rcme {
namespace {

constexpr const char* kStandIn = "msac";

// Returns the estimator with only its own search and score, without optional wrappers (a robust covariance,
// the gate of model choice).
std::unique_ptr<MotionEstimator> Bare(EstimatorSpec spec) {
  for (const auto& [option, value] : Settings{{"covariance", "own"}, {"model_choice", "off"}}) {
    try {
      SetOptions(&spec, {{option, value}});
    } catch (const InputError&) {
      // has no such option, or one with other values
    }
  }
  return Make(spec);
}

double RotationDeg(const RelativePose& a, const RelativePose& b) {
  return kDegPerRad * RotationAngleBetween(a.R, b.R);
}
double DirectionDeg(const RelativePose& a, const RelativePose& b) {
  return kDegPerRad * AngleBetween(a.t, b.t);
}

// The distance of a motion from the truth, compared with the bounds of the study.
struct Distance {
  double rotation_deg, direction_deg;
  bool is_direction_known, is_within;

  Distance(const RelativePose& pose, const Truth& truth, const FailureBounds& bounds)
      : rotation_deg(RotationDeg(pose, *truth.cam2_from_cam1_true)),
        direction_deg(DirectionDeg(pose, *truth.cam2_from_cam1_true)),
        is_direction_known(truth.is_direction_known),
        is_within(rotation_deg <= bounds.max_rotation_error_deg &&
                  (!truth.is_direction_known || direction_deg <= bounds.max_direction_error_deg)) {}
  std::string Words() const {
    return is_direction_known ? fmt::format("{:.2g} deg off in rotation, {:.2g} deg in direction",
                                            rotation_deg, direction_deg)
                              : fmt::format("{:.2g} deg off in rotation", rotation_deg);
  }
};

// Describes the score of a motion: its inliers, and the number by which the estimator chooses.
std::string ScoreWords(const ScoredMotion& motion) {
  const InlierScore& score = motion.score;
  const std::string words = fmt::format("{} matches that pass its test", score.num_inliers);
  switch (motion.decides) {
    case DecidingScore::kMeanEntropy:
      return words + fmt::format(", mean entropy {:.3f}", score.mean_entropy);
    case DecidingScore::kCost:
      return words + fmt::format(", cost {:.1f}", score.negative_log_likelihood);
    case DecidingScore::kNumInliers:
      break;
  }
  return words;
}

// Returns the advantage of a over b in standard deviations of the difference that occurs by chance if both
// explain the same right matches. The number of n matches beyond a test of level alpha is binomial; a
// squared residual has variance 2; the variance of a mean entropy follows from its spread. The two are
// treated as independent, which makes the result rather too small.
double Advantage(const ScoredMotion& a, const ScoredMotion& b, double significance_level) {
  const InlierScore &x = a.score, &y = b.score;
  const double n = std::max({x.num_inliers, y.num_inliers, 1});
  const auto variance_of_mean = [](const InlierScore& score) {
    return score.sum_squares / std::pow(std::max(score.num_inliers, 1), 2);
  };
  switch (a.decides) {
    case DecidingScore::kMeanEntropy:
      return (y.mean_entropy - x.mean_entropy) / std::sqrt(variance_of_mean(x) + variance_of_mean(y));
    case DecidingScore::kCost:
      return (y.negative_log_likelihood - x.negative_log_likelihood) / std::sqrt(4.0 * n);
    case DecidingScore::kNumInliers:
      break;
  }
  return (x.num_inliers - y.num_inliers) /
         std::sqrt(2.0 * n * significance_level * (1.0 - significance_level));
}
constexpr double kClear = 2.0;

// Returns which of the motions the estimator would choose if its loop had found only these; nothing if none
// passes its tests.
std::optional<size_t> Chosen(const LoopInspection& estimator, int num_matches,
                             const std::vector<const ScoredMotion*>& motions) {
  RansacOptions options = estimator.options();
  options.num_iterations = static_cast<int>(motions.size());
  options.early_stop_entropy = std::numeric_limits<double>::quiet_NaN();
  HypothesisTrace trace{num_matches, motions.front()->thresholds, {}};
  for (const ScoredMotion* motion : motions) {
    const HypothesisId id{{}, static_cast<int>(trace.hypotheses.size())};
    trace.hypotheses.push_back({{id, SampleVerdict::kConsistent, true}, motion->score});
  }
  const LoopResult loop = estimator.With(options)->Decide(trace);
  if (!loop.winner) return std::nullopt;
  auto chosen = static_cast<size_t>(loop.winner->id.model);
  for (const Candidate& other : loop.runners_up) {  // of several refined motions, the one that explains most
    const auto k = static_cast<size_t>(other.id.model);
    if (motions[k]->estimate.num_explained > motions[chosen]->estimate.num_explained) chosen = k;
  }
  return chosen;
}

class RansacWhy {
 public:
  RansacWhy(const LoopInspection& estimator, const TrialData& data, const FailureBounds& bounds)
      : estimator_(estimator),
        data_(data),
        bounds_(bounds),
        truth_(estimator.ScoreMotion(data.problem, *data.truth.cam2_from_cam1_true)) {}

  // Explains a motion beyond the bounds.
  Why OfFailure(const RelativePose& answer) const {
    if (const auto why = OfTruthWithoutOptimum()) return *why;
    const ScoredMotion scored = estimator_.ScoreMotion(data_.problem, answer);
    const std::string truth_words = ScoreWords(truth_);
    if (!scored.refined.converged)
      return {WhyVerdict::kSearchFailed,
              "the answer is no optimum of the matches, the true motion has one (" + truth_words + ")",
              {}};
    const std::string words =
        fmt::format("the true motion has {}; the answer {}", truth_words, ScoreWords(scored));
    const std::optional<size_t> chosen = Chosen(estimator_, NumMatches(), {&scored, &truth_});
    const double advantage = Advantage(truth_, scored, estimator_.options().significance_level);
    if (chosen && *chosen == 1 && advantage > kClear) return {WhyVerdict::kSearchFailed, words, {}};
    return {WhyVerdict::kModelCannotTell, words, {}};
  }

  Why OfRefusal() const {
    if (const auto why = OfTruthWithoutOptimum()) return *why;
    const std::string words = "the true motion has " + ScoreWords(truth_);
    if (!Chosen(estimator_, NumMatches(), {&truth_}))
      return {WhyVerdict::kTestsRefuse, words + ", and the test of its inlier set refuses it", {}};
    if (truth_.estimate.status != MotionStatus::kOk) {
      return {WhyVerdict::kTestsRefuse,
              fmt::format("{}, and would be refused: {}", words, StatusName(truth_.estimate.status)),
              {}};
    }
    return {WhyVerdict::kSearchFailed, words + ", and would have been accepted", {}};
  }

 private:
  int NumMatches() const { return static_cast<int>(data_.problem.matches.size()); }

  // Returns an explanation if no optimum reached from the truth lies near it.
  std::optional<Why> OfTruthWithoutOptimum() const {
    if (!truth_.refined.converged)
      return Why{WhyVerdict::kModelCannotTell, "the matches have no optimum near the true motion", {}};
    const Distance distance(truth_.refined.cam2_from_cam1, data_.truth, bounds_);
    if (distance.is_within) return std::nullopt;
    return Why{WhyVerdict::kModelCannotTell,
               "the optimum that is reached from the true motion is itself " + distance.Words(),
               {}};
  }

  const LoopInspection& estimator_;
  const TrialData& data_;
  const FailureBounds& bounds_;
  ScoredMotion truth_;
};

constexpr double kSure = 0.9;

// Explains by the probability that rcme_calibrated itself gives the true motion, had its search found it.
Why WhyByWeights(const WeightInspection& estimator, const TrialData& data, const MotionEstimate& estimate,
                 const FailureBounds& bounds) {
  std::vector<RelativePose> starts = {*data.truth.cam2_from_cam1_true};
  if (estimate.status == MotionStatus::kOk) starts.push_back(estimate.cam2_from_cam1);
  double weight = 0.0;
  int most_explained = 0;
  bool is_answer = false;
  for (const WeighedMotion& motion : estimator.WeighMotions(data.problem, starts)) {
    if (!Distance(motion.cam2_from_cam1, data.truth, bounds).is_within) continue;
    weight += motion.weight;
    most_explained = std::max(most_explained, motion.num_explained);
    is_answer |= motion.is_answer;
  }
  if (most_explained == 0) {
    return {
        WhyVerdict::kModelCannotTell, "the matches have no optimum within the bounds of the true motion", {}};
  }
  const std::string words =
      fmt::format("had it been found, the true motion ({} matches agree) would have had probability {:.2g}",
                  most_explained, weight);
  if (is_answer && weight > kSure && estimate.status != MotionStatus::kTooUncertain)
    return {WhyVerdict::kSearchFailed, words, {}};
  return {WhyVerdict::kModelCannotTell, words, {}};
}

Why WhyNotRight(const EstimatorSpec& spec, const TrialData& data, const MotionEstimate& estimate,
                const FailureBounds& bounds) {
  const MotionStatus status = estimate.status;
  const bool is_gate = status == MotionStatus::kPlanarScene || status == MotionStatus::kRotationOnly ||
                       status == MotionStatus::kTooLittleParallax;
  if (is_gate)
    return {
        WhyVerdict::kTestsRefuse, "the gate of model choice refuses the problem: " + estimate.message, {}};
  if (IsBadInput(status)) return {WhyVerdict::kTestsRefuse, estimate.message, {}};
  std::unique_ptr<MotionEstimator> estimator = Bare(spec);
  if (const WeightInspection* calibrated = FindWeightInspection(*estimator))
    return WhyByWeights(*calibrated, data, estimate, bounds);
  const bool has_own_score = FindInspection(*estimator) != nullptr;
  if (!has_own_score) estimator = MakeEstimator(kStandIn);
  const RansacWhy of(*FindInspection(*estimator), data, bounds);
  Why why = status == MotionStatus::kOk ? of.OfFailure(estimate.cam2_from_cam1) : of.OfRefusal();
  if (!has_own_score) why.words += fmt::format(" (by {}, in place of its own score)", kStandIn);
  return why;
}

std::string RunnerUpWords(const MotionEstimate& estimate, const TrialData& data,
                          const FailureBounds& bounds) {
  const MotionMode* found = FindRunnerUp(estimate);
  if (found == nullptr) return {};
  const MotionMode& other = *found;
  std::string words =
      fmt::format("probability {:.2g}, {:.3g} deg and {:.3g} deg (rotation, direction) from the answer",
                  other.weight, RotationDeg(other.cam2_from_cam1, estimate.cam2_from_cam1),
                  DirectionDeg(other.cam2_from_cam1, estimate.cam2_from_cam1));
  if (data.truth.cam2_from_cam1_true && Distance(other.cam2_from_cam1, data.truth, bounds).is_within)
    words += "; within the bounds of the true motion";
  return words;
}

// Whether an estimator outside of the program raised an error or gave nothing that can be read.
bool IsWithoutAnswer(MotionStatus status) {
  return status == MotionStatus::kLibraryError || status == MotionStatus::kNoAnswer ||
         status == MotionStatus::kTimedOut || status == MotionStatus::kUnreadableAnswer;
}

const char* Meaning(WhyVerdict verdict) {
  return PickName(verdict, {"right", "the search failed", "the model cannot tell",
                            "its tests refuse the true motion as well", "it gave no answer",
                            "the true motion is unknown"});
}

std::vector<int> RightMatches(const TrialData& data) {
  const std::vector<bool>& is_inlier = data.truth.is_inlier_true;
  const ReferenceMatches matches(data.problem, RefinementError::kSampson);
  if (is_inlier.empty())
    return matches.FindConsistent(*data.truth.cam2_from_cam1_true, ConsistencyThreshold(0.05));
  std::vector<int> right;
  for (size_t i = 0; i < is_inlier.size(); ++i) {
    if (is_inlier[i]) right.push_back(static_cast<int>(i));
  }
  return right;
}

// The evidence for the true motion: from the right matches if they are known, else from those that agree with
// it at 95 %. Nothing if the truth is not known.
std::optional<MotionEvidence> EvidenceOfTruth(const TrialData& data) {
  if (!data.truth.cam2_from_cam1_true) return std::nullopt;
  MotionEstimate truth;
  truth.status = MotionStatus::kOk;
  truth.cam2_from_cam1 = *data.truth.cam2_from_cam1_true;
  truth.inliers = RightMatches(data);
  return ComputeEvidence(data.problem, truth);
}

}  // namespace

const char* Name(WhyVerdict verdict) {
  return PickName(
      verdict, {"right", "search_failed", "model_cannot_tell", "tests_refuse", "no_answer", "truth_unknown"});
}

Why ExplainOutcome(const EstimatorSpec& spec, const TrialData& data, const MotionEstimate& estimate,
                   const TrialRecord& record, const FailureBounds& bounds) {
  Why why;
  if (IsInvalid(record)) {
    why = {WhyVerdict::kSearchFailed, "the answer is not valid: " + estimate.message, {}};
  } else if (IsWithoutAnswer(estimate.status)) {
    why = {WhyVerdict::kNoAnswer, estimate.message, {}};
  } else if (HasSucceeded(record, bounds)) {
    why = {WhyVerdict::kRight, {}, {}};
  } else if (data.truth.cam2_from_cam1_true && !data.truth.is_in_doubt) {
    why = WhyNotRight(spec, data, estimate, bounds);
  }
  why.runner_up = RunnerUpWords(estimate, data, bounds);
  return why;
}

std::string WhyAsText(const StudyPlan& plan, const TrialResult& result) {
  std::string text = "\nWhy\n";
  if (const std::optional<MotionEvidence> e = EvidenceOfTruth(result.data)) {
    text += fmt::format(
        "  {} right matches, noise {:.2g} px ({:.2g} px assumed), parallax {:.2g} deg: {:.1f} times its\n"
        "  noise; {:.0f} % could lie on one plane\n",
        e->num_inliers, e->sigma_px, e->sigma_assumed_px, e->parallax_median_deg, e->parallax_to_noise,
        100.0 * e->planar_share);
  }
  for (size_t e = 0; e < result.estimates.size(); ++e) {
    const EstimatorSpec& spec = plan.study.estimators[e];
    const Why why =
        ExplainOutcome(spec, result.data, result.estimates[e], result.records[e], plan.study.failure);
    text += fmt::format("  {}: {}\n", spec.label, Meaning(why.verdict));
    if (!why.words.empty()) text += fmt::format("    {}\n", why.words);
    if (!why.runner_up.empty()) text += fmt::format("    runner-up: {}\n", why.runner_up);
  }
  return text;
}

}  // namespace rcme
