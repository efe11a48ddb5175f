#include "experiments/audit/model_choice/true_kind.h"

#include <numbers>

#include "estimator/model_choice/homography.h"
#include "estimator/observability.h"
#include "estimator/reference_matches.h"
#include "estimator/refinement/rotation_mle.h"
#include "simulator/exact_match.h"
#include "simulator/severity/homography_share.h"
#include "stats/distributions.h"
#include "stats/moments.h"

namespace rcme {
namespace {

constexpr int kLeastRightMatches = 8;

double ExpectedParallaxShare(const MotionProblem& exact, const Eigen::Matrix3d& R_true,
                             double significance_level) {
  const ReferenceMatches matches(exact, RefinementError::kSampson);
  const double fit_threshold = TailThreshold(static_cast<int>(exact.matches.size()), significance_level);
  const RotationFit rotation = FitRotation(matches, matches.All(), R_true, fit_threshold);
  const double bound = ChiSquareQuantile(2, 1.0 - significance_level);
  Moments beyond;
  for (const double delta2 : SquaredTransfers(RayMatches(exact), rotation.R)) {
    // Beyond 1e4 the probability is 1 to all digits.
    beyond.Add(delta2 < 1e4 ? 1.0 - NonCentralChiSquareCdf(2, delta2, bound) : 1.0);
  }
  return beyond.mean();
}

}  // namespace

const std::string& Name(TrueKind kind) {
  static const std::string borderline = "borderline";
  return kind == TrueKind::kBorderline ? borderline : Name(static_cast<SceneVerdict>(kind));
}

KindMeasures MeasureKind(const Scene& scene, std::span<const Eigen::Vector3d> points_in_cam1, double sigma_px,
                         double parallax_significance_level, RandomStream& rng) {
  KindMeasures measures{.num_points = static_cast<int>(points_in_cam1.size()),
                        .baseline_m = scene.baseline_m,
                        .parallax_share = 0.0,
                        .plane_share = 0.0};
  if (measures.num_points < kLeastRightMatches) return measures;
  MotionProblem exact{{}, scene.camera1, scene.camera2, sigma_px};
  for (const Eigen::Vector3d& point : points_in_cam1) exact.matches.push_back(PinholeMatch(scene, point));
  measures.parallax_share =
      ExpectedParallaxShare(exact, scene.cam2_from_cam1_true.R, parallax_significance_level);
  measures.plane_share = HomographyShare(scene, points_in_cam1, std::numbers::sqrt2 * sigma_px, rng);
  return measures;
}

TrueKind ClassifyKind(const KindMeasures& measures, double least_parallax_share) {
  if (measures.num_points < kLeastRightMatches) return TrueKind::kBorderline;
  if (!(measures.baseline_m > 0.0)) return TrueKind::kRotationOnly;
  if (measures.parallax_share <= 0.5 * least_parallax_share) return TrueKind::kTooLittleParallax;
  if (measures.parallax_share < 2.0 * least_parallax_share) return TrueKind::kBorderline;
  if (measures.plane_share >= kPlaneOfAll) return TrueKind::kPlanar;
  return measures.plane_share <= kPlaneOfGeneral ? TrueKind::kGeneral : TrueKind::kBorderline;
}

}  // namespace rcme
