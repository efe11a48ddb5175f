#include "estimator/calibrated/unstated_errors.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "estimator/calibrated/mode_covariance.h"

namespace rcme {

Matrix5d UnstatedErrors::AddTo(const Matrix5d& covariance) const {
  return BoundByUniformMotion(covariance + moment);
}

Matrix5d UnstatedErrors::MixInto(const Matrix5d& covariance) const {
  if (probability == 0.0) return covariance;
  return (1.0 - probability) * covariance + probability * AddTo(covariance);
}

UnstatedErrors WeighUnstatedErrors(const IntrinsicsCheck& check, double prior_probability,
                                   double variance_factor) {
  using Square = decltype(check.information);
  const Eigen::Index size = check.information.rows();
  const Eigen::LLT<Square> precision(check.information / variance_factor + Square::Identity(size, size));
  if (precision.info() != Eigen::Success) return {};
  const Square V = precision.solve(Square::Identity(size, size));
  const auto theta = (V * check.score / variance_factor).eval();
  const double log_det = -2.0 * precision.matrixLLT().diagonal().array().log().sum();
  const double log_factor = 0.5 * (check.score.dot(theta) / variance_factor + log_det);
  const double log_odds = std::log(prior_probability) - std::log1p(-prior_probability) + log_factor;
  const UnstatedErrors errors{
      .probability = 1.0 / (1.0 + std::exp(-log_odds)),
      .moment = check.of_motion * (V + theta * theta.transpose()) * check.of_motion.transpose()};
  return std::isfinite(errors.probability) && errors.moment.allFinite() ? errors : UnstatedErrors{};
}

}  // namespace rcme
