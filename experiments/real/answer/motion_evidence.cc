#include "experiments/real/answer/motion_evidence.h"

#include <cmath>

#include "estimator/calibrated/match_terms.h"
#include "estimator/model_choice/two_view_models.h"
#include "estimator/noise_scale.h"
#include "estimator/problem_check.h"
#include "experiments/data/data_source.h"
#include "experiments/real/truth_free/twin.h"
#include "stats/constants.h"
#include "stats/median_ratio.h"

namespace rcme {
namespace {

constexpr double kLevel = 0.001;

// The median of the sizes of n normal residuals has an asymptotic efficiency of 0.37: sd / sigma = 1 /
// sqrt(2 * 0.37 n).
double SdOfNoise(double sigma_px, size_t n) { return sigma_px / std::sqrt(0.74 * static_cast<double>(n)); }

void MeasureParallax(const MotionProblem& inliers, const RelativePose& pose, MotionEvidence* evidence) {
  std::vector<double> angles_deg, to_noise;
  for (size_t i = 0; i < inliers.matches.size(); ++i) {
    const Correspondence& match = inliers.matches[i];
    const Eigen::Vector3d ray1 = inliers.camera1.Ray(match.x1_px), ray2 = inliers.camera2.Ray(match.x2_px);
    angles_deg.push_back(kDegPerRad * AngleBetween(pose.R * ray1, ray2));
    to_noise.push_back(EvaluateMatch(inliers, pose, match, NoiseScaleAt(inliers, i)).mean_depth);
  }
  evidence->parallax_median_deg = ComputeMedian(std::move(angles_deg));
  evidence->parallax_to_noise = ComputeMedian(std::move(to_noise));
}

double ComputeInlierShare(const ModelFit& fit, TwoViewModel model) {
  return static_cast<double>(FindInliers(fit, model, kLevel).size()) /
         static_cast<double>(fit.squared_residuals.size());
}

}  // namespace

bool MotionEvidence::DoesNoiseDisagree() const {
  const double difference = std::abs(sigma_px - sigma_assumed_px);
  const bool is_large = sigma_px > 1.25 * sigma_assumed_px || sigma_px < 0.8 * sigma_assumed_px;
  return is_large && difference > 3.0 * sigma_sd_px;
}

MotionEvidence ComputeEvidence(const MotionProblem& problem, const MotionEstimate& estimate) {
  MotionProblem inliers = SelectPart(problem, estimate.inliers);
  MotionEvidence evidence;
  evidence.num_matches = static_cast<int>(problem.matches.size());
  evidence.num_inliers = static_cast<int>(inliers.matches.size());
  evidence.sigma_assumed_px = InImagePixels(problem, problem.sigma_px);
  evidence.sigma_px = evidence.sigma_sd_px = kNaN;
  evidence.parallax_median_deg = evidence.parallax_to_noise = kNaN;
  evidence.parallax_share = evidence.planar_share = kNaN;
  if (RefuseUnsolvable(inliers, 6)) return evidence;
  evidence.sigma_px = EstimateNoise(problem, estimate);
  evidence.sigma_sd_px = std::isfinite(estimate.sigma_estimated_sd_px)
                             ? estimate.sigma_estimated_sd_px
                             : SdOfNoise(evidence.sigma_px, inliers.matches.size());
  // The tests use the measured noise, but at least a small part of the assumed one.
  inliers.sigma_px = std::max(evidence.sigma_px, 0.01 * problem.sigma_px);
  MeasureParallax(inliers, estimate.cam2_from_cam1, &evidence);
  RandomStream rng = StreamFor({1, 0, 0, 0}, StreamPurpose::kCheck);
  const TwoViewFits fits = FitTwoViewModels(inliers, rng);
  evidence.parallax_share = 1.0 - ComputeInlierShare(fits.rotation, TwoViewModel::kRotation);
  evidence.planar_share = ComputeInlierShare(fits.homography, TwoViewModel::kHomography);
  evidence.sigma_px = InImagePixels(problem, evidence.sigma_px);
  evidence.sigma_sd_px = InImagePixels(problem, evidence.sigma_sd_px);
  return evidence;
}

}  // namespace rcme
