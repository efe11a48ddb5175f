// The density that an answer's covariance states, with its sharpness and proper scores, which complement
// coverage. The density is N(0, Sigma_p) of the motion's tangent coordinates [rotation, direction] (rad) at
// the estimate.
#pragma once

#include "estimator/motion_estimate.h"
#include "experiments/data/data_source.h"
#include "stats/constants.h"

namespace rcme {

// Unknown numbers are NaN.
inline constexpr double kLevelRisk = 0.01;  // integrity risk of the protection levels in every record

struct StatedDensity {
  enum class Kind {
    kNone,      // no valid answer, or no covariance
    kRegular,   // positive definite
    kSingular,  // states some direction of the tangent space exactly, so there is no density
  };

  int kind = 0;                    // value of the Kind
  double rotation_sd_deg = kNaN;   // stated rms error: root of the trace of the rotation block
  double direction_sd_deg = kNaN;  // the same for the direction block
  // Geometric mean of the ratios of these two to their Cramer-Rao bounds, which are also roots of traces. An
  // unbiased estimator that states less than 1 is overconfident.
  double sd_over_crb = kNaN;
  double log_det_cov = kNaN;  // ln det Sigma_p, rad^10
  // Scores of the error against the truth (stats/normal_scores.h). If the truth has an uncertainty of its
  // own, they use the sum of both covariances.
  double energy_score_deg = kNaN;
  double log_score = kNaN;  // nats; finite or unknown
  // The errors exceed these with probability at most kLevelRisk (estimator/protection_level.h).
  double rotation_level_deg = kNaN, direction_level_deg = kNaN;

  bool HasCovariance() const { return kind != static_cast<int>(Kind::kNone); }
  bool IsSingular() const { return kind == static_cast<int>(Kind::kSingular); }
};

// For a checked answer (answer_check.h). `truth` and the bounds in `severity` may be unknown. `nees` is that
// of the answer (NaN: unknown).
StatedDensity DescribeStatedDensity(const MotionEstimate& estimate, const Truth& truth,
                                    const Severity& severity, double nees);

}  // namespace rcme
