#pragma once

#include <Eigen/Cholesky>
#include <cstdint>
#include <limits>

#include "stats/intervals.h"

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

// The acceptance bounds of the mean of n NEES values with `degrees_of_freedom` each. Their sum is chi-square
// with n dof degrees of freedom, so the mean lies in [chi2_(n dof)(alpha / 2), chi2_(n dof)(1 - alpha / 2)] /
// n (Bar-Shalom, Li & Kirubarajan 2001, section 5.4).
Interval AneesBounds(std::int64_t n, int degrees_of_freedom, double confidence = 0.95);

// Average NEES of a stream of trials. Above its bounds the covariances are too small (optimistic), below them
// too large. An infinite NEES makes the mean infinite and a NaN makes it NaN; both count as inconsistent.
class Anees {
 public:
  explicit Anees(int degrees_of_freedom) : degrees_of_freedom_(degrees_of_freedom) {}
  void Add(double nees) { sum_ += nees, ++n_; }
  void Merge(const Anees& other) { sum_ += other.sum_, n_ += other.n_; }

  std::int64_t n() const { return n_; }
  int degrees_of_freedom() const { return degrees_of_freedom_; }
  double mean() const { return sum_ / static_cast<double>(n_); }  // expected: degrees_of_freedom()
  Interval bounds(double confidence = 0.95) const { return AneesBounds(n_, degrees_of_freedom_, confidence); }
  bool IsConsistent(double confidence = 0.95) const { return bounds(confidence).Contains(mean()); }

 private:
  int degrees_of_freedom_;
  std::int64_t n_ = 0;
  double sum_ = 0.0;
};

}  // namespace rcme
