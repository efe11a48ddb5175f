#include "estimator/calibrated/unstated_errors.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <optional>

#include "estimator/calibrated/mode_covariance.h"

namespace rcme {
namespace {

// ln B for the errors whose standard deviations, over the usual ones, are not zero in `sd`; and V, the
// covariance of theta given the matches. Nothing if it is not finite.
struct ErrorLaw {
  double log_factor;
  IntrinsicsEvidence::Square covariance;
};
std::optional<ErrorLaw> FindErrorLaw(const IntrinsicsEvidence& evidence,
                                     const IntrinsicsEvidence::Vector& sd) {
  using Square = IntrinsicsEvidence::Square;
  const Square identity = Square::Identity(sd.size(), sd.size());
  const Eigen::LLT<Square> precision(sd.asDiagonal() * evidence.information * sd.asDiagonal() + identity);
  if (precision.info() != Eigen::Success) return std::nullopt;
  const ErrorLaw law{-precision.matrixLLT().diagonal().array().log().sum(),
                     sd.asDiagonal() * Square(precision.solve(identity)) * sd.asDiagonal()};
  return ErrorLaw{law.log_factor + 0.5 * evidence.score.dot(law.covariance * evidence.score), law.covariance};
}

// The odds of a probability, times exp(log_factor).
double MultiplyOdds(double probability, double log_factor) {
  return 1.0 / (1.0 + std::exp(std::log1p(-probability) - std::log(probability) - log_factor));
}

// A law of the motion N(mean, covariance), mean relative to the answer, given the prior.
struct UpdatedLaw {
  double log_density;  // of the prior's residuals, but for a constant
  Vector5d mean;
  Matrix5d covariance;
};
UpdatedLaw UpdateLaw(const Vector5d& mean, const Matrix5d& covariance, const PriorResiduals& prior) {
  using Square = Eigen::Matrix<double, 9, 9>;
  const auto& J = prior.jacobian;
  const Eigen::Matrix<double, 5, 9> cross = covariance * J.transpose();
  const Eigen::LLT<Square> spread(Square(Square::Identity() + J * cross));
  const Eigen::Matrix<double, 9, 1> residual = prior.residual + J * mean, weighted = spread.solve(residual);
  return {-0.5 * residual.dot(weighted) - spread.matrixLLT().diagonal().array().log().sum(),
          mean - cross * weighted, covariance - cross * spread.solve(cross.transpose())};
}

}  // namespace

Matrix5d UnstatedErrors::AddTo(const Matrix5d& covariance) const {
  return BoundByUniformMotion(covariance + Moment());
}

Matrix5d UnstatedErrors::MixInto(const Matrix5d& covariance) const {
  const Matrix5d without = BoundByUniformMotion(covariance);
  if (probability == 0.0) return without;
  return (1.0 - probability) * without + probability * AddTo(covariance);
}

UnstatedErrors WeighUnstatedErrors(const IntrinsicsEvidence& evidence, double prior_probability) {
  const IntrinsicsEvidence::Vector& stated = evidence.stated_sd;
  const IntrinsicsEvidence::Vector is_unstated = (stated.array() == 0.0).cast<double>();
  const auto of_all = FindErrorLaw(evidence, stated + is_unstated),
             of_stated = FindErrorLaw(evidence, stated);
  if (!of_all || !of_stated) return {};
  const auto of_motion = (evidence.of_motion * is_unstated.asDiagonal()).eval();
  const UnstatedErrors errors{
      .probability = MultiplyOdds(prior_probability, of_all->log_factor - of_stated->log_factor),
      .shift = of_motion * (of_all->covariance * evidence.score),
      .spread = of_motion * of_all->covariance * of_motion.transpose()};
  return std::isfinite(errors.probability) && errors.Moment().allFinite() ? errors : UnstatedErrors{};
}

UnstatedErrors FindUnstatedErrors(const MotionProblem& problem, const Mode& mode,
                                  const Explanation& explanation, const CalibratedOptions& options) {
  const CalibrationPrior& stated = options.calibration;
  const bool are_all_stated =
      stated.focal_sd > 0.0 && stated.principal_point_sd_px > 0.0 && stated.distortion_sd > 0.0;
  if (options.unstated_errors == 0.0 || are_all_stated) return {};
  return WeighUnstatedErrors(FindIntrinsicsEvidence(problem, mode, explanation, stated),
                             options.unstated_errors);
}

UnstatedErrors UpdateByPrior(const UnstatedErrors& errors, const Matrix5d& covariance_of_matches,
                             const PriorResiduals& at_answer) {
  // The answer is the mean of the first law given the prior.
  const Vector5d from_answer = covariance_of_matches * at_answer.jacobian.transpose() * at_answer.residual;
  const UpdatedLaw exact = UpdateLaw(from_answer, covariance_of_matches, at_answer),
                   wrong = UpdateLaw(from_answer + errors.shift, covariance_of_matches + errors.spread,
                                     at_answer);
  const UnstatedErrors updated{
      .probability = MultiplyOdds(errors.probability, wrong.log_density - exact.log_density),
      .shift = wrong.mean,
      .spread = wrong.covariance - exact.covariance};
  return std::isfinite(updated.probability) && updated.Moment().allFinite() ? updated : errors;
}

}  // namespace rcme
