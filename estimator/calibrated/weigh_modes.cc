#include "estimator/calibrated/weigh_modes.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "estimator/calibrated/candidates.h"
#include "estimator/geometry/pose.h"

namespace rcme {
namespace {

// ln det(s^2 H) of the information of the matches alone; 0 if it is not positive definite.
double LogDetOfGeometry(const Mode& mode, const MotionPrior* prior) {
  const Eigen::LLT<Matrix5d> llt(FindMatchInformation(prior, mode));
  if (llt.info() != Eigen::Success) return 0.0;
  return 2.0 * llt.matrixLLT().diagonal().array().log().sum() + 10.0 * std::log(mode.mixture.scale);
}

ModeTraits FindTraits(const ExplainedMode& mode, const MotionPrior* prior, CalibratedStep leave_out) {
  ModeTraits traits{.num_explained = mode.explanation.num_explained,
                    .scale = mode.mode.mixture.scale,
                    .log_det = LogDetOfGeometry(mode.mode, prior)};
  if (leave_out == CalibratedStep::kUsualMotions) return traits;
  traits.forwardness = ComputeForwardness(mode.mode.pose);
  traits.turn_rad = VectorFromRotation(mode.mode.pose.R).norm();
  return traits;
}

class ModeComparison {
 public:
  explicit ModeComparison(std::span<const ExplainedMode> modes, const MotionPrior* prior = nullptr,
                          CalibratedStep leave_out = CalibratedStep::kNone)
      : modes_(modes), prior_evidence_(modes.size(), 0.0) {
    for (const ExplainedMode& mode : modes) traits_.push_back(FindTraits(mode, prior, leave_out));
    for (size_t i = 0; prior != nullptr && i < modes.size(); ++i)
      prior_evidence_[i] = ComputePriorEvidence(*prior, modes[i].mode);
  }
  Contrast Compare(size_t a, size_t b) const {
    const double background =
        std::max(modes_[a].mode.mixture.outlier_density, modes_[b].mode.mixture.outlier_density);
    return CompareModes(modes_[a].explanation, modes_[b].explanation, background);
  }
  double LogOdds(size_t a, size_t b, const Contrast& contrast) const {
    if (IsSecondMotion(contrast)) return PriorLogOdds(a, b) - SecondLogOdds(1.0, a, b, contrast);
    return PriorLogOdds(a, b) + ModeLogOdds(contrast, traits_[a], traits_[b]);
  }
  double PriorLogOdds(size_t a, size_t b) const { return prior_evidence_[a] - prior_evidence_[b]; }
  double SecondLogOdds(double odds, size_t answer, size_t second, const Contrast& contrast) const {
    const auto [of_answer, of_second] = FindSupports(answer, second, contrast);
    return SecondMotionLogOdds(odds, of_answer, of_second);
  }
  double PriorEvidence(size_t i) const { return prior_evidence_[i]; }
  ModePair Pair(size_t a, size_t b) const {
    const Contrast contrast = Compare(a, b);
    const auto [of_a, of_b] = FindSupports(a, b, contrast);
    return {a, b, ComputeModeTerms(contrast, traits_[a], traits_[b]), IsSecondMotion(contrast),
            ComputeSecondMotionTerms(of_a, of_b)};
  }
  double LogOdds(size_t a, size_t b) const { return LogOdds(a, b, Compare(a, b)); }

 private:
  std::pair<MotionSupport, MotionSupport> FindSupports(size_t a, size_t b, const Contrast& contrast) const {
    return {{contrast.num_better_a, modes_[a].explanation.extent},
            {contrast.num_better_b, modes_[b].explanation.extent}};
  }

  std::span<const ExplainedMode> modes_;
  std::vector<ModeTraits> traits_;
  std::vector<double> prior_evidence_;  // nats
};

constexpr size_t kWeighingRounds = 3;

// Passes over the modes until none is more likely than the answer. There are at most three passes, because
// the odds of three modes need not be transitive.
size_t ChooseAnswer(const std::vector<ExplainedMode>& modes, const ModeComparison& comparison) {
  size_t answer = 0;
  for (size_t round = 0, num_beaten = 0; round < kWeighingRounds && num_beaten + 1 < modes.size(); ++round) {
    num_beaten = 0;
    for (size_t i = 0; i < modes.size(); ++i) {
      if (i == answer || (round == 0 && i < answer)) continue;
      if (comparison.LogOdds(answer, i) < 0.0) {
        answer = i;
        num_beaten = 0;
      } else {
        ++num_beaten;
      }
    }
  }
  return answer;
}

constexpr double kRivalExponent = 2.5;
// Upper bound of the log-odds of no motion against the answer: even with evidence against any motion, one in
// five answers from ten to thirty matches was right.
constexpr double kGreatestNoneLogOdds = 2.0;

// Scales the odds of the modes within the bounds around the answer to a sum of one, and those of its rivals
// to their norm with exponent kRivalExponent.
void ScaleOdds(const std::vector<bool>& is_rival, std::vector<double>* odds) {
  double same = 0.0, rivals = 0.0, powers = 0.0;
  for (size_t i = 0; i < odds->size(); ++i) {
    (is_rival[i] ? rivals : same) += (*odds)[i];
    if (is_rival[i]) powers += std::pow((*odds)[i], kRivalExponent);
  }
  const double rival_factor = rivals > 0.0 ? std::pow(powers, 1.0 / kRivalExponent) / rivals : 0.0;
  for (size_t i = 0; i < odds->size(); ++i) (*odds)[i] *= is_rival[i] ? rival_factor : 1.0 / same;
}

}  // namespace

double ComputeLogOdds(const ExplainedMode& a, const ExplainedMode& b, const MixturePrior& prior,
                      CalibratedStep leave_out) {
  const std::array<ExplainedMode, 2> both = {a, b};
  return ModeComparison(both, prior.motion, leave_out).LogOdds(0, 1);
}

std::vector<bool> FindRivals(const std::vector<ExplainedMode>& modes, size_t answer,
                             const MotionBounds& bounds) {
  std::vector<bool> is_rival;
  for (const ExplainedMode& mode : modes)
    is_rival.push_back(!IsWithin(modes[answer].mode.pose, bounds, mode.mode.pose));
  return is_rival;
}

ModeWeights WithoutCopies(const std::vector<ExplainedMode>& modes, ModeWeights weights) {
  for (size_t i = 0; i < modes.size(); ++i) {
    if (i == weights.answer || !IsSameMode(modes[weights.answer].mode, modes[i].mode, 1.0)) continue;
    weights.of_modes[weights.answer] += weights.of_modes[i];
    weights.of_modes[i] = 0.0;
  }
  return weights;
}

ModeWeights WeighModes(const std::vector<ExplainedMode>& modes, const MotionBounds& bounds,
                       const MixturePrior& prior, const CalibratedOptions& options) {
  const ModeComparison comparison(modes, prior.motion, options.leave_out);
  ModeWeights weights;
  weights.answer = ChooseAnswer(modes, comparison);
  weights.is_rival = FindRivals(modes, weights.answer, bounds);
  const ExplainedMode& answer = modes[weights.answer];
  for (size_t i = 0; i < modes.size(); ++i) {
    const Contrast contrast = comparison.Compare(weights.answer, i);
    const bool is_second = i != weights.answer && IsSecondMotion(contrast);
    double log_odds = i == weights.answer ? 0.0 : -comparison.LogOdds(weights.answer, i, contrast);
    if (is_second)
      log_odds = comparison.SecondLogOdds(options.second_motion_odds, weights.answer, i, contrast) +
                 comparison.PriorLogOdds(i, weights.answer);
    weights.is_second_motion.push_back(is_second);
    weights.of_modes.push_back(std::exp(std::min(log_odds, 0.0)));
  }
  ScaleOdds(weights.is_rival, &weights.of_modes);
  const double background = std::max(prior.uniform_density, answer.mode.mixture.outlier_density);
  const double evidence = EvidenceOfMotion(answer.explanation, answer.mode.mixture, background) +
                          comparison.PriorEvidence(weights.answer);
  weights.of_no_motion = std::exp(std::min(-evidence, kGreatestNoneLogOdds));
  double total = weights.of_no_motion;
  for (const double weight : weights.of_modes) total += weight;
  for (double& weight : weights.of_modes) weight /= total;
  weights.of_no_motion /= total;
  return weights;
}

std::vector<ModePair> ListModePairs(const std::vector<ExplainedMode>& modes) {
  const ModeComparison comparison(modes);
  std::vector<ModePair> pairs;
  for (size_t a = 0; a < modes.size(); ++a)
    for (size_t b = a + 1; b < modes.size(); ++b) pairs.push_back(comparison.Pair(a, b));
  return pairs;
}

}  // namespace rcme
