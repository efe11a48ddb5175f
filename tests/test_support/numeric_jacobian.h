// The numeric twin of an analytic Jacobian.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace rcme {

// df/dx (m x n) of a function R^n -> R^m, f(const Eigen::VectorXd&) -> Eigen column vector: central
// differences with steps h and h / 2, extrapolated (Richardson), error O(h^4) + O(eps / h). `steps` holds one
// h per coordinate, in its own units.
template <typename Function>
Eigen::MatrixXd NumericJacobian(const Function& f, const Eigen::VectorXd& x, const Eigen::VectorXd& steps) {
  const auto slope = [&](Eigen::Index k, double h) -> Eigen::VectorXd {
    Eigen::VectorXd ahead = x, behind = x;
    ahead(k) += h;
    behind(k) -= h;
    const Eigen::VectorXd f_ahead = f(ahead), f_behind = f(behind);
    return (f_ahead - f_behind) / (ahead(k) - behind(k));  // the step that was really taken
  };
  Eigen::MatrixXd jacobian;
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const Eigen::VectorXd column = (4.0 * slope(k, 0.5 * steps(k)) - slope(k, steps(k))) / 3.0;
    if (k == 0) jacobian.resize(column.size(), x.size());
    jacobian.col(k) = column;
  }
  return jacobian;
}

// The same with one step for every coordinate.
template <typename Function>
Eigen::MatrixXd NumericJacobian(const Function& f, const Eigen::VectorXd& x, double step = 1e-3) {
  return NumericJacobian(f, x, Eigen::VectorXd(Eigen::VectorXd::Constant(x.size(), step)));
}

// Whether every entry agrees to `tolerance` times the largest entry of the numeric Jacobian. A zero, an
// infinite or a NaN Jacobian on either side fails. A failure prints both.
inline testing::AssertionResult JacobiansAgree(const Eigen::MatrixXd& analytic,
                                               const Eigen::MatrixXd& numeric, double tolerance) {
  const auto fail = [&](const char* why) {
    return testing::AssertionFailure() << why << "\nanalytic:\n" << analytic << "\nnumeric:\n" << numeric;
  };
  if (analytic.rows() != numeric.rows() || analytic.cols() != numeric.cols()) return fail("sizes differ");
  if (!analytic.allFinite() || !numeric.allFinite()) return fail("not finite");
  const double scale = numeric.size() > 0 ? numeric.cwiseAbs().maxCoeff() : 0.0;
  if (!(scale > 0.0)) return fail("the numeric Jacobian is zero: this point tests nothing");
  const double ratio = analytic.norm() / numeric.norm();
  if (!(ratio > 0.5 && ratio < 2.0)) return fail("the norms are not comparable");
  const double error = (analytic - numeric).cwiseAbs().maxCoeff() / scale;
  if (!(error <= tolerance)) {
    return fail("entries differ") << "\nlargest difference over largest entry: " << error
                                  << ", allowed: " << tolerance;
  }
  return testing::AssertionSuccess();
}

}  // namespace rcme

#define EXPECT_JACOBIAN_NEAR(analytic, numeric, tolerance) \
  EXPECT_TRUE(::rcme::JacobiansAgree(analytic, numeric, tolerance))
