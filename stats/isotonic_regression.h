// The non-decreasing function that fits best: least squares under y(x1) <= y(x2) for x1 < x2.
#pragma once

#include <span>
#include <vector>

namespace rcme {

// Pool adjacent violators (Ayer et al. 1955): of all non-decreasing sequences the one of least weighted
// squared distance to `values`. Linear time. Throws std::invalid_argument unless there are as many weights,
// all above 0.
std::vector<double> PoolAdjacentViolators(std::span<const double> values, std::span<const double> weights);

// A fitted function: fitted.y[i] at fitted.x[i].
struct IsotonicFit {
  std::vector<double> x;  // the different ones, rising
  std::vector<double> y;  // non-decreasing

  // Straight lines between the points, constant outside. Throws std::invalid_argument without points or for
  // NaN.
  double At(double at) const;
};

// Equal x are one point, the mean of their y. Throws std::invalid_argument if there are no points, not as
// many y as x, or a NaN among them; x may be infinite.
IsotonicFit FitIsotonic(std::span<const double> x, std::span<const double> y);

}  // namespace rcme
