#include "experiments/real/truth_free/self_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/real/truth_free/kept_answers.h"
#include "stats/fnv1a.h"

namespace rcme {
namespace {

constexpr double kSmallStep = 0.1;  // of half an interval
constexpr double kFaultLevel = 1.0 - kFaultConfidence;

Eigen::Index FindFaultIndex(CameraFault fault) { return static_cast<Eigen::Index>(fault); }

// The pairs corrected for faults; the readout of each for its estimated motion.
std::vector<NamedPair> RemoveFrom(const std::vector<PairAnswers>& answers, const FaultVector& faults) {
  const std::vector<double> scales = ReadoutScales(answers);
  std::vector<NamedPair> pairs;
  for (size_t i = 0; i < answers.size(); ++i) {
    const Answered& whole = answers[i].whole;
    FaultVector of_pair = faults;
    of_pair(FindFaultIndex(CameraFault::kReadoutTime)) *= whole.IsOk() ? scales[i] : 0.0;
    pairs.push_back(whole.pair);
    pairs.back().problem = RemoveFaults(whole.pair.problem, whole.estimate.cam2_from_cam1, of_pair);
  }
  return pairs;
}

Answered AnswerPair(NamedPair pair, const MotionEstimator& estimator, std::uint64_t seed, KeptSteps* steps) {
  MotionEstimate estimate =
      TakeAnswer(pair.problem, estimator, {seed, HashToStreamKey(pair.name), 0, 0}, steps);
  return {std::move(pair), std::move(estimate)};
}

// Estimates for the pairs corrected for faults.
std::vector<PairAnswers> AnswerWithout(const FaultVector& faults, const std::vector<PairAnswers>& answers,
                                       const MotionEstimator& estimator, std::uint64_t seed,
                                       KeptSteps* steps) {
  std::vector<PairAnswers> corrected;
  for (NamedPair& pair : RemoveFrom(answers, faults)) {
    corrected.push_back({AnswerPair(std::move(pair), estimator, seed, steps), {}});
  }
  return corrected;
}

// Converged estimates of some faults, with the others zero.
struct Fit {
  std::vector<CameraFault> faults;
  FaultVector theta = FaultVector::Zero();
  PooledScores pooled;       // of these faults; estimates are those of theta
  FaultEstimates estimates;  // of the pairs without them
  int num_steps = 0;
};

class Steps {
 public:
  Steps(const std::vector<PairAnswers>& answers, const MotionEstimator& estimator, std::uint64_t seed,
        KeptSteps* kept)
      : answers_(answers), estimator_(estimator), seed_(seed), kept_(kept), start_(EstimateFaults(answers)) {}

  const FaultEstimates& start() const { return start_; }

  // nullopt: the steps do not converge or leave the possible range.
  std::optional<Fit> Take(const std::vector<CameraFault>& faults) const {
    Fit fit{faults, FaultVector::Zero(), PoolFaults(start_.units, faults), start_, 0};
    while (fit.num_steps < kMostSteps) {
      ++fit.num_steps;
      for (size_t j = 0; j < faults.size(); ++j) {
        double& theta = fit.theta(FindFaultIndex(faults[j]));
        theta += fit.pooled.parameters[j].value;
        if (!(std::abs(theta) <= GreatestFault(faults[j], start_.camera))) return std::nullopt;
      }
      fit.estimates = EstimateFaults(AnswerWithout(fit.theta, answers_, estimator_, seed_, kept_));
      if (fit.estimates.units.empty()) return std::nullopt;
      fit.pooled = PoolFaults(fit.estimates.units, faults);
      if (!AreSmall(fit.pooled)) continue;
      for (size_t j = 0; j < faults.size(); ++j)
        MoveTo(fit.theta(FindFaultIndex(faults[j])), &fit.pooled.parameters[j]);
      return fit;
    }
    return std::nullopt;
  }

 private:
  static bool AreSmall(const PooledScores& steps) {
    return std::ranges::all_of(steps.parameters, [](const PooledParameter& step) {
      return std::abs(step.value) <= 0.5 * kSmallStep * (step.interval.upper - step.interval.lower);
    });
  }
  static void MoveTo(double theta, PooledParameter* of) {
    for (double* x : {&of->value, &of->interval.lower, &of->interval.upper}) *x += theta;
  }

  const std::vector<PairAnswers>& answers_;
  const MotionEstimator& estimator_;
  std::uint64_t seed_;
  KeptSteps* kept_;
  FaultEstimates start_;
};

std::vector<CameraFault> NamedFaults(const CalibrationReport& report) {
  std::vector<CameraFault> named;
  for (const FaultReport& each : report.faults) {
    if (IsFault(each.verdict)) named.push_back(each.fault);
  }
  return named;
}

// The most significant other fault of the pairs after correction for the fit's faults.
std::optional<CameraFault> FindFurther(const Fit& fit, const std::vector<CameraFault>& asked) {
  std::optional<CameraFault> further;
  double most = 0.0;
  for (const CameraFault fault : asked) {
    if (std::ranges::count(fit.faults, fault) > 0) continue;
    const PooledParameter alone = PoolFaults(fit.estimates.units, {fault}).parameters.front();
    const double size = std::abs(alone.value) / alone.standard_error;
    if (alone.interval.Contains(0.0) || !(size > most)) continue;
    most = size;
    further = fault;
  }
  return further;
}

// Corrects the named faults, and further significant ones, until the test of all faults passes.
void CorrectNamed(const Steps& steps, CalibrationReport* report) {
  std::vector<CameraFault> taken = NamedFaults(*report);
  std::optional<Fit> fit;
  double p_left = 0.0;
  for (;;) {
    fit = steps.Take(taken);
    if (!fit) return NameNothing("corrections alone do not converge", report);
    p_left = PoolFaults(fit->estimates.units, fit->estimates.asked).p_value;
    if (p_left >= kFaultLevel) break;
    const std::optional<CameraFault> further = FindFurther(*fit, fit->estimates.asked);
    if (!further)
      return NameNothing(fmt::format("what they look like, corrected, leaves p = {:.2g}", p_left), report);
    taken.push_back(*further);
  }
  if (const std::optional<CameraFault> other = FindOtherFault(fit->estimates.units)) {
    report->is_of_other_kind = true;
    return NameNothing(
        fmt::format("something of another kind is left, such as {}", FindFaultText(*other).words), report);
  }
  for (size_t j = 0; j < taken.size(); ++j) {
    FaultReport& each = *std::ranges::find(report->faults, taken[j], &FaultReport::fault);
    if (!IsFault(each.verdict)) each.joint = fit->pooled.parameters[j];
    each.correction = fit->theta(FindFaultIndex(taken[j]));
    each.verdict = each.correction > 0.0 ? TruthFreeVerdict::kTooLarge : TruthFreeVerdict::kTooSmall;
  }
  report->p_corrected = p_left;
}

}  // namespace

CalibrationReport Calibrate(const std::vector<PairAnswers>& answers, const MotionEstimator& estimator,
                            std::uint64_t seed, KeptSteps* steps) {
  CalibrationReport report = TestCalibration(answers);
  if (!NamesFault(report)) return report;
  const Steps corrections(answers, estimator, seed, steps);
  const std::optional<Fit> all = corrections.Take(corrections.start().asked);
  if (!all) {
    NameNothing(fmt::format("{} steps do not converge", kMostSteps), &report);
    return report;
  }
  report.num_steps = all->num_steps;
  for (size_t j = 0; j < report.faults.size(); ++j) report.faults[j].joint = all->pooled.parameters[j];
  JudgeFaults(&report);
  if (!NamesFault(report)) {
    if (report.why_unnamed.empty()) report.why_unnamed = "none is left once the steps have converged";
    return report;
  }
  CorrectNamed(corrections, &report);
  return report;
}

PairSet CorrectPairs(const PairSet& set, const CalibrationReport& report, const MotionEstimator& estimator,
                     std::uint64_t seed, KeptSteps* steps) {
  FaultVector theta = FaultVector::Zero();
  for (const FaultReport& each : report.faults) theta(FindFaultIndex(each.fault)) = each.correction;
  std::vector<PairAnswers> answers;
  for (const NamedPair& pair : set.pairs) answers.push_back({AnswerPair(pair, estimator, seed, steps), {}});
  return {set.name, RemoveFrom(answers, theta)};
}

}  // namespace rcme
