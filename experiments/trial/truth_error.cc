#include "experiments/trial/truth_error.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "stats/constants.h"

namespace rcme {
namespace {

double GreatestSd(const Eigen::MatrixXd& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(solver.eigenvalues().maxCoeff(), 0.0));
}

}  // namespace

TruthErrorDeg ComputeTruthErrorDeg(const Truth& truth) {
  if (!truth.sd || !truth.cam2_from_cam1_true) return {};
  const Matrix5d covariance = truth.sd->CovarianceAt(*truth.cam2_from_cam1_true);
  const double scale_deg = kDegPerRad * kTruthErrorSds;
  return {scale_deg * GreatestSd(covariance.topLeftCorner<3, 3>()),
          scale_deg * GreatestSd(covariance.bottomRightCorner<2, 2>())};
}

std::string DescribeRealTruth(bool is_sd_stated) {
  const std::string text =
      "The truth of real pairs is taken as exact: its errors count as errors of the estimator.";
  return is_sd_stated ? text : text + " No pair states how accurate its truth is (truth_sd).";
}

}  // namespace rcme
