// Isotonic regression: least squares under y(x1) <= y(x2) for x1 < x2.
#pragma once

#include <span>
#include <vector>

namespace rcme {

// Pool adjacent violators (Ayer et al. 1955): the non-decreasing sequence of least weighted squared distance
// to `values`. Linear time. Throws std::invalid_argument unless there are as many weights, all above 0.
std::vector<double> PoolAdjacentViolators(std::span<const double> values, std::span<const double> weights);

// A fitted function: fitted.y[i] at fitted.x[i].
struct IsotonicFit {
  std::vector<double> x;  // distinct, ascending
  std::vector<double> y;  // non-decreasing

  // Linear between the points, constant outside. Throws std::invalid_argument without points or for NaN.
  double At(double at) const;
};

// Equal x become one point with the mean of their y. x may be infinite. Throws std::invalid_argument if there
// are no points, a different number of x and y, or a NaN.
IsotonicFit FitIsotonic(std::span<const double> x, std::span<const double> y);

}  // namespace rcme
