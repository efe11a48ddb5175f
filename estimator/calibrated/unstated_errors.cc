#include "estimator/calibrated/unstated_errors.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "estimator/calibrated/mode_covariance.h"

namespace rcme {

Matrix5d UnstatedErrors::AddTo(const Matrix5d& covariance) const {
  return BoundByUniformMotion(covariance + moment);
}

Matrix5d UnstatedErrors::MixInto(const Matrix5d& covariance) const {
  const Matrix5d without = BoundByUniformMotion(covariance);
  if (probability == 0.0) return without;
  return (1.0 - probability) * without + probability * AddTo(covariance);
}

UnstatedErrors WeighUnstatedErrors(const IntrinsicsEvidence& evidence, double prior_probability) {
  using Square = decltype(evidence.information);
  const Eigen::Index size = evidence.information.rows();
  const Eigen::LLT<Square> precision(evidence.information + Square::Identity(size, size));
  if (precision.info() != Eigen::Success) return {};
  const Square V = precision.solve(Square::Identity(size, size));
  const auto theta = (V * evidence.score).eval();
  const double log_det = -2.0 * precision.matrixLLT().diagonal().array().log().sum();
  const double log_factor = 0.5 * (evidence.score.dot(theta) + log_det);
  const double log_odds = std::log(prior_probability) - std::log1p(-prior_probability) + log_factor;
  const UnstatedErrors errors{
      .probability = 1.0 / (1.0 + std::exp(-log_odds)),
      .moment = evidence.of_motion * (V + theta * theta.transpose()) * evidence.of_motion.transpose()};
  return std::isfinite(errors.probability) && errors.moment.allFinite() ? errors : UnstatedErrors{};
}

}  // namespace rcme
