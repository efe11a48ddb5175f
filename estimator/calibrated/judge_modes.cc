#include "estimator/calibrated/judge_modes.h"

#include <algorithm>

#include "estimator/calibrated/checked_probability.h"
#include "estimator/calibrated/failure_probability.h"
#include "estimator/calibrated/intrinsics_check.h"
#include "estimator/calibrated/unstated_errors.h"
#include "stats/constants.h"

namespace rcme {
namespace {

// Modes below this weight use the Gauss-Newton Hessian: the observed one costs ten passes over the matches.
constexpr double kSmallWeight = 0.01;

// The factor by which the check widens the covariance.
double FindCheckFactor(const ModelCheck& check, const CalibratedOptions& options) {
  const bool is_checked =
      options.covariance == CovarianceKind::kSandwich && options.leave_out != CalibratedStep::kModelCheck;
  return is_checked ? CovarianceFactor(check) : 1.0;
}

// How much of the probability within the bounds is left by stated errors of the intrinsics, at least 1e-6:
// with the check, by their excess over the usual ones, which it counts. `curvature`: InverseOfObserved.
// `reach`: the covariance of the answer if the intrinsics are exact.
double ComputeLeftByIntrinsics(const JudgedModes& judged, const Mode& mode, const Matrix5d& curvature,
                               const Matrix5d& reach, RandomStream& rng) {
  const CalibratedOptions& options = judged.options;
  const bool is_checked = options.leave_out != CalibratedStep::kModelCheck;
  const CalibrationPrior unknown = is_checked ? ExceedUsualErrors(options.calibration) : options.calibration;
  if (unknown.IsNone()) return 1.0;
  const Matrix5d of_unknown = IntrinsicsCovariance(judged.problem, unknown, mode, curvature);
  const MotionBounds bounds = MakeMotionBounds(options);
  RandomStream same = rng;
  const double exact = MassWithin(mode.pose, bounds, mode.pose, reach, same);
  const double uncertain = MassWithin(mode.pose, bounds, mode.pose, reach + of_unknown, rng);
  return std::clamp(uncertain / std::max(exact, 1e-6), 1e-6, 1.0);
}

// The errors that the covariance counts.
UnstatedErrors FindErrorsOfAnswer(const JudgedModes& judged) {
  const auto& [mode, explanation] = judged.modes[judged.weights.answer];
  const UnstatedErrors errors = FindUnstatedErrors(judged.problem, mode, explanation, judged.options);
  if (errors.probability == 0.0 || judged.prior.motion == nullptr) return errors;
  return UpdateByPrior(errors, FindMatchInformation(judged.prior.motion, mode).inverse(),
                       ComputePriorResiduals(*judged.prior.motion, mode.pose));
}

// With a robust covariance, MakeCovarianceRobust comes before the errors and the bound.
ModeSpread MakeSpread(const Matrix5d& covariance, const UnstatedErrors& errors,
                      const CalibratedOptions& options) {
  if (options.covariance == CovarianceKind::kRobust) return {covariance, covariance, covariance};
  return {BoundByUniformMotion(covariance), errors.AddTo(covariance), errors.MixInto(covariance)};
}

// The spread of an answer whose direction is weak. Near the optimum the likelihood does not show how far the
// direction may be away: without parallax it seems well determined (direction_posterior.h).
ModeSpread SpreadWeakDirection(const JudgedModes& judged, const UnstatedErrors& errors,
                               const Matrix5d& of_intrinsics) {
  const auto& covariance = judged.weak_direction->covariance;
  const bool is_robust = judged.options.covariance == CovarianceKind::kRobust;
  return MakeSpread(
      is_robust ? covariance
                : Matrix5d(FindCheckFactor(judged.check, judged.options) * covariance + of_intrinsics),
      errors, judged.options);
}

}  // namespace

MotionBounds MakeMotionBounds(const CalibratedOptions& options) {
  return {kRadPerDeg * options.max_rotation_error_deg, kRadPerDeg * options.max_direction_error_deg};
}

ModesVerdict JudgeModes(const JudgedModes& judged, RandomStream& rng, std::vector<ModeSpread>* spreads) {
  const auto& [problem, matches, prior, modes, weights, weak_direction, check, options] = judged;
  const MotionBounds bounds = MakeMotionBounds(options);
  const Mode& answer = modes[weights.answer].mode;
  double within = 0.0, success = 0.0;
  ModesVerdict verdict;
  verdict.unstated_errors = FindErrorsOfAnswer(judged);
  std::optional<ModeSpread> of_weak;
  if (spreads != nullptr) spreads->assign(modes.size(), {});
  for (size_t i = 0; i < modes.size(); ++i) {
    const double weight = weights.of_modes[i];
    const Mode& mode = modes[i].mode;
    if (weight < kNegligibleWeight && i != weights.answer) continue;
    const bool is_exact = weight > kSmallWeight || i == weights.answer;
    const Matrix5d curvature = is_exact ? InverseOfObserved(matches, mode, prior) : mode.inverse_hessian;
    // Along a direction that the noise seems to determine, the observed curvature is below that from the
    // residuals' first derivatives. The score varies as the latter says: H_obs^-1 H H_obs^-1.
    const Matrix5d reach = curvature * mode.hessian * curvature;
    success += weight * (weak_direction && !weights.is_second_motion[i]
                             ? weak_direction->mass_within
                             : MassWithin(answer.pose, bounds, mode.pose, reach, rng));
    const Matrix5d of_intrinsics = IntrinsicsCovariance(problem, options.calibration, mode, curvature);
    if (i == weights.answer) {
      const Matrix5d exact = weak_direction ? Matrix5d(Matrix5d::Zero()) : reach;
      verdict.left_by_intrinsics = ComputeLeftByIntrinsics(judged, mode, curvature, exact, rng);
      if (weak_direction) of_weak = SpreadWeakDirection(judged, verdict.unstated_errors, of_intrinsics);
    }
    if (spreads != nullptr) (*spreads)[i].exact = reach + of_intrinsics;
    if (!IsWithin(answer.pose, bounds, mode.pose)) continue;
    const Vector5d away = LocalCoordinates(answer.pose, mode.pose);
    const ModeSpread spread =
        MakeSpread(ComputeModeCovariance(modes[i], curvature, of_intrinsics, check, prior, options),
                   verdict.unstated_errors, options);
    if (spreads != nullptr) (*spreads)[i] = spread;
    const Matrix5d to_answer = TransportTangent(mode.pose, answer.pose);
    const auto second_moment = [&](const Matrix5d& covariance) -> Matrix5d {
      return weight * (to_answer * covariance * to_answer.transpose() + away * away.transpose());
    };
    verdict.pose_cov.exact += second_moment(spread.exact);
    verdict.pose_cov.with_errors += second_moment(spread.with_errors);
    verdict.pose_cov.mixed += second_moment(spread.mixed);
    within += weight;
  }
  for (Matrix5d* each : {&verdict.pose_cov.exact, &verdict.pose_cov.with_errors, &verdict.pose_cov.mixed})
    *each /= within;
  if (of_weak) verdict.pose_cov = *of_weak;
  verdict.mass_beyond = std::max(within - success, 0.0);
  verdict.by_modes = verdict.failure_probability = std::clamp(1.0 - success, 0.0, 1.0);
  return verdict;
}

Matrix5d ComputeModeCovariance(const ExplainedMode& mode, const Matrix5d& curvature,
                               const Matrix5d& of_intrinsics, const ModelCheck& check,
                               const MixturePrior& prior, const CalibratedOptions& options) {
  Matrix5d of_prior = Matrix5d::Zero();  // the inverse information includes the prior
  Matrix5d of_matches = options.covariance == CovarianceKind::kInformation
                            ? mode.mode.inverse_hessian
                            : SandwichCovariance(mode.mode, mode.explanation, curvature);
  if (prior.motion != nullptr && options.covariance != CovarianceKind::kInformation)
    of_prior = PriorCovariance(mode.mode, prior, curvature);
  if (options.covariance == CovarianceKind::kRobust)
    return of_matches + of_prior;  // MakeCovarianceRobust adds the shared errors
  of_matches *= FindCheckFactor(check, options);
  return of_matches + of_prior + of_intrinsics;
}

}  // namespace rcme
