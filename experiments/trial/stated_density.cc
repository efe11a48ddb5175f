#include "experiments/trial/stated_density.h"

#include <cmath>

#include "estimator/protection_level.h"
#include "stats/normal_scores.h"

namespace rcme {
namespace {

constexpr int kDimension = 5;

void DescribeSharpness(const Matrix5d& pose_cov, const Severity& severity, StatedDensity* density) {
  density->rotation_sd_deg = kDegPerRad * std::sqrt(pose_cov.topLeftCorner<3, 3>().trace());
  density->direction_sd_deg = kDegPerRad * std::sqrt(pose_cov.bottomRightCorner<2, 2>().trace());
  const double bounds = severity.crb_rotation_deg * severity.crb_direction_deg;
  if (bounds > 0.0)
    density->sd_over_crb = std::sqrt(density->rotation_sd_deg * density->direction_sd_deg / bounds);
}

void DescribeLevels(const MotionEstimate& estimate, StatedDensity* density) {
  const ProtectionLevels levels = ComputeProtectionLevels(estimate, kLevelRisk);
  density->rotation_level_deg = kDegPerRad * levels.rotation_rad;
  density->direction_level_deg = kDegPerRad * levels.direction_rad;
}

}  // namespace

StatedDensity DescribeStatedDensity(const MotionEstimate& estimate, const Truth& truth,
                                    const Severity& severity, double nees) {
  using Kind = StatedDensity::Kind;
  StatedDensity density;
  if (estimate.status != MotionStatus::kOk) return density;
  DescribeSharpness(estimate.pose_cov, severity, &density);
  DescribeLevels(estimate, &density);
  density.log_det_cov = LogDeterminant(estimate.pose_cov);
  density.kind = static_cast<int>(std::isnan(density.log_det_cov) ? Kind::kSingular : Kind::kRegular);
  if (!truth.cam2_from_cam1_true || !truth.is_direction_known) return density;
  const RelativePose& pose = estimate.cam2_from_cam1;
  Matrix5d covariance = estimate.pose_cov;
  if (truth.sd) covariance += truth.sd->CovarianceAt(pose);
  const Vector5d error = LocalCoordinates(pose, *truth.cam2_from_cam1_true);
  density.energy_score_deg = kDegPerRad * EnergyScore(error, covariance);
  if (density.kind != static_cast<int>(Kind::kRegular)) return density;
  const double log_score =
      LogScore(nees, truth.sd ? LogDeterminant(covariance) : density.log_det_cov, kDimension);
  if (std::isfinite(log_score)) density.log_score = log_score;
  return density;
}

}  // namespace rcme
