// What an answer's covariance says, and how good that is: sharpness and proper scores beside the coverage.
// The stated density is N(0, Sigma_p) of the motion's tangent coordinates [rotation, direction] (rad) at the
// estimate, as its user has it.
#pragma once

#include "estimator/motion_estimate.h"
#include "experiments/data/data_source.h"
#include "stats/constants.h"

namespace rcme {

// Unknown numbers are NaN.
inline constexpr double kLevelRisk = 0.01;  // integrity risk of the protection levels of every trial

struct StatedDensity {
  enum class Kind {
    kNone,      // no valid answer, no covariance
    kRegular,   // positive definite
    kSingular,  // no density: it claims to know a direction exactly
  };

  int kind = 0;                    // number of the Kind
  double rotation_sd_deg = kNaN;   // root of the trace of the rotation's block: the rms error that it states
  double direction_sd_deg = kNaN;  // the same of the direction's block
  // Geometric mean of the two over their Cramer-Rao bounds, which are such roots as well: no estimator
  // without bias can rightly state less than 1.
  double sd_over_crb = kNaN;
  double log_det_cov = kNaN;  // ln det Sigma_p, rad^10
  // Of the error against the truth (stats/normal_scores.h). A truth with an error of its own is a draw of the
  // sum of both densities, and so are these scores of the sum.
  double energy_score_deg = kNaN;
  double log_score = kNaN;  // nats; finite or unknown
  // What the errors exceed with probability kLevelRisk at most (estimator/protection_level.h).
  double rotation_level_deg = kNaN, direction_level_deg = kNaN;

  bool HasCovariance() const { return kind != static_cast<int>(Kind::kNone); }
  bool IsSingular() const { return kind == static_cast<int>(Kind::kSingular); }
};

// Of an answer that was judged (answer_check.h). `truth` and the bounds of `severity` may be unknown; `nees`
// is the answer's (NaN: unknown).
StatedDensity DescribeStatedDensity(const MotionEstimate& estimate, const Truth& truth,
                                    const Severity& severity, double nees);

}  // namespace rcme
