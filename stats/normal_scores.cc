#include "stats/normal_scores.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <numbers>

#include "stats/portable_math.h"

namespace rcme {
namespace {

// The points of the rule: u = -14, -13.5, ... until the integrand is below kNegligibleShare of the sum.
constexpr double kLogStep = 0.5, kFirstLog = -14.0;
constexpr int kNumStepsToPeak = 28, kMaxNumSteps = 120;
constexpr double kNegligibleShare = 1e-10;

}  // namespace

double MeanDistance(const Eigen::VectorXd& variances, const Eigen::VectorXd& e) {
  static const double ratio = PortableExp(kLogStep), first = PortableExp(kFirstLog);
  // Below the first point the integrand is E Q sqrt(t), which falls by this factor per step.
  static const double below = 1.0 / (PortableExp(0.5 * kLogStep) - 1.0);
  const Eigen::Index dimension = variances.size();
  const double mean_square = variances.sum() + e.squaredNorm();
  if (mean_square == 0.0) return 0.0;
  double t = first / mean_square, sum = 0.0;
  for (int k = 0; k < kMaxNumSteps; ++k, t *= ratio) {
    double product = 1.0, exponent = 0.0, slope = 0.0;
    for (Eigen::Index i = 0; i < dimension; ++i) {
      const double inverse = 1.0 / (1.0 + 2.0 * variances(i) * t);
      const double square = e(i) * e(i) * inverse;
      product *= inverse;
      exponent += t * square;
      slope += variances(i) * inverse + square * inverse;
    }
    const double value = std::sqrt(product * t) * PortableExp(-exponent) * slope;
    sum += k == 0 ? value * (1.0 + below) : value;
    if (k > kNumStepsToPeak && value < kNegligibleShare * sum) break;
  }
  return kLogStep * sum / std::sqrt(std::numbers::pi);
}

double EnergyScore(const Eigen::VectorXd& e, const Eigen::MatrixXd& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  const Eigen::VectorXd variances = solver.eigenvalues().cwiseMax(0.0);
  const Eigen::VectorXd along = solver.eigenvectors().transpose() * e;
  return MeanDistance(variances, along) -
         MeanDistance(variances, Eigen::VectorXd::Zero(e.size())) / std::numbers::sqrt2;
}

double LogDeterminant(const Eigen::MatrixXd& covariance) {
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
  if (llt.info() != Eigen::Success) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0.0;
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) sum += PortableLog(llt.matrixLLT()(i, i));
  return 2.0 * sum;
}

double LogScore(double normalized_error_squared, double log_determinant, int dimension) {
  static const double log_two_pi = PortableLog(2.0 * std::numbers::pi);
  return 0.5 * (normalized_error_squared + log_determinant + dimension * log_two_pi);
}

}  // namespace rcme
