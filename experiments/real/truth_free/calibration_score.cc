#include "experiments/real/truth_free/calibration_score.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "estimator/geometry/sampson.h"
#include "estimator/noise_scale.h"
#include "estimator/refinement/sampson_equations.h"
#include "experiments/real/truth_free/twin.h"

namespace rcme {
namespace {

constexpr int kBoth = kNumCameraFaults + 5;
constexpr size_t kLeastInliers = 20;

double ComputeWeight(const MotionProblem& problem, const MotionEstimate& estimate, size_t i,
                     double sigma_px) {
  const double probability = estimate.inlier_probabilities.empty() ? 1.0 : estimate.inlier_probabilities[i];
  const double sd_px = sigma_px * NoiseScaleAt(problem, i);
  return probability / (sd_px * sd_px);
}

}  // namespace

Eigen::Matrix<double, 1, kNumCameraFaults> ResidualByFaults(const Eigen::Matrix3d& F, const Camera& camera1,
                                                            const Camera& camera2,
                                                            const RelativePose& cam2_from_cam1,
                                                            const Correspondence& match) {
  constexpr double kStepPx = 1e-3;
  const EpipolarConstraint c = EvaluateConstraint(F, match);
  const double norm = std::sqrt(c.squared_gradient()), r = c.g / norm;
  const Eigen::Vector4d u = c.gradient / norm;
  const Eigen::RowVector4d r_X = (u - r / norm * ConstraintHessian(F) * u).transpose();
  const auto shifts_at = [&](double step_px) {
    const Correspondence moved{match.x1_px + step_px * u.head<2>(), match.x2_px + step_px * u.tail<2>()};
    return ComputeShifts(camera1, camera2, cam2_from_cam1, moved);
  };
  const ShiftsByFaults along_u = (shifts_at(kStepPx) - shifts_at(-kStepPx)) / (2.0 * kStepPx);  // d_X u
  return r_X * shifts_at(0.0) - r * u.transpose() * along_u;
}

std::optional<CalibrationScore> ScoreCalibration(const MotionProblem& problem,
                                                 const MotionEstimate& estimate) {
  if (estimate.inliers.size() < kLeastInliers) return std::nullopt;
  const RelativePose& pose = estimate.cam2_from_cam1;
  const SampsonLinearization model({{}, problem.camera1, problem.camera2, 1.0}, pose);  // px
  const Eigen::Matrix3d F = ComputeFundamental(problem, pose);
  const double sigma_px = EstimateNoise(problem, estimate);
  Eigen::Matrix<double, kBoth, kBoth> normal = Eigen::Matrix<double, kBoth, kBoth>::Zero();
  Eigen::Matrix<double, kBoth, 1> moments = Eigen::Matrix<double, kBoth, 1>::Zero();
  for (const int index : estimate.inliers) {
    const auto i = static_cast<size_t>(index);
    const Correspondence& match = problem.matches[i];
    const SampsonResidual residual = model.Evaluate(match);
    Eigen::Matrix<double, kBoth, 1> row;
    row << ResidualByFaults(F, problem.camera1, problem.camera2, pose, match).transpose(), residual.r_p;
    const double weight = ComputeWeight(problem, estimate, i, sigma_px);
    normal += weight * row * row.transpose();
    moments += weight * residual.r * row;
  }
  const Eigen::LLT<Matrix5d> of_motion{Matrix5d(normal.bottomRightCorner<5, 5>())};
  if (of_motion.info() != Eigen::Success || !normal.allFinite()) return std::nullopt;
  const Eigen::Matrix<double, kNumCameraFaults, 5> B =
      of_motion.solve(normal.bottomLeftCorner<5, kNumCameraFaults>()).transpose();
  return CalibrationScore{moments.head<kNumCameraFaults>() - B * moments.tail<5>(),
                          normal.topLeftCorner<kNumCameraFaults, kNumCameraFaults>() -
                              B * normal.bottomLeftCorner<5, kNumCameraFaults>()};
}

}  // namespace rcme
