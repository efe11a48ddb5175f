#include "tests/test_support/numeric_jacobian.h"

#include <cmath>
#include <limits>

namespace rcme {
namespace {

Eigen::VectorXd Curve(const Eigen::VectorXd& x) {
  return Eigen::Vector3d(std::sin(x(0)) * x(1), std::exp(0.5 * x(0)), x(0) * x(0) * x(1));
}

Eigen::MatrixXd CurveJacobian(double x, double y) {
  Eigen::MatrixXd jacobian(3, 2);
  jacobian << std::cos(x) * y, std::sin(x), 0.5 * std::exp(0.5 * x), 0.0, 2.0 * x * y, x * x;
  return jacobian;
}

TEST(NumericJacobian, AgreesWithClosedForm) {
  const Eigen::MatrixXd numeric = NumericJacobian(Curve, Eigen::Vector2d(0.7, -1.3));
  EXPECT_JACOBIAN_NEAR(CurveJacobian(0.7, -1.3), numeric, 1e-11);
}

TEST(NumericJacobian, WrongJacobiansAreSeen) {
  const Eigen::MatrixXd numeric = NumericJacobian(Curve, Eigen::Vector2d(0.7, -1.3));
  const Eigen::MatrixXd right = CurveJacobian(0.7, -1.3);
  Eigen::MatrixXd one_entry = right;
  one_entry(2, 1) += 1e-6;
  Eigen::MatrixXd not_a_number = right;
  not_a_number(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(JacobiansAgree(Eigen::MatrixXd::Zero(3, 2), numeric, 1e9)) << "a zero matrix passed";
  EXPECT_FALSE(JacobiansAgree(Eigen::MatrixXd::Zero(3, 2), Eigen::MatrixXd::Zero(3, 2), 1.0));
  EXPECT_FALSE(JacobiansAgree(-right, numeric, 1e-8));
  EXPECT_FALSE(JacobiansAgree(right.transpose(), numeric, 1e-8));
  EXPECT_FALSE(JacobiansAgree(one_entry, numeric, 1e-8));
  EXPECT_FALSE(JacobiansAgree(not_a_number, numeric, 1e9));
}

}  // namespace
}  // namespace rcme
