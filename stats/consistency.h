#pragma once

#include <Eigen/Cholesky>
#include <limits>

namespace rcme {

// Normalised estimation error squared e' Sigma^-1 e (NEES): chi-square with as many degrees of freedom as e
// has coordinates if e ~ N(0, Sigma). Infinite if Sigma is not positive definite, as it then claims exact
// knowledge of a direction.
template <typename Vector, typename Matrix>
double NormalizedErrorSquared(const Vector& error, const Matrix& covariance) {
  const Eigen::LLT<Matrix> llt(covariance);
  if (llt.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  return error.dot(llt.solve(error));
}

}  // namespace rcme
