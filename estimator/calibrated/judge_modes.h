// Steps 7 and 8 of rcme_calibrated: the probability of failure and the covariance of the answer, from all
// modes.
#pragma once

#include <optional>
#include <vector>

#include "estimator/calibrated/mode_covariance.h"
#include "estimator/calibrated/model_check.h"
#include "estimator/calibrated/modes_verdict.h"
#include "estimator/calibrated/settle_direction.h"

namespace rcme {

inline constexpr double kNegligibleWeight = 1e-5;  // of a mode that neither judges nor joins the posterior

// What a verdict is of. References: they must outlive the call.
struct JudgedModes {
  const MotionProblem& problem;
  const MatchBlocks& matches;
  const MixturePrior& prior;
  const std::vector<ExplainedMode>& modes;
  const ModeWeights& weights;
  const std::optional<WeakDirection>& weak_direction;
  const ModelCheck& check;
  const CalibratedOptions& options;
};

MotionBounds MakeMotionBounds(const CalibratedOptions& options);

// The verdict before the model check corrects the probability. The covariance is the second moment, about the
// answer, of the modes within the bounds or, if the direction is weak, of the directions within 90 deg of the
// answer's (settle_direction.h). `spreads`, if not null, receives one element per mode. Beyond the bounds
// only `exact` is set, to the reach of the mode's likelihood; all are zero if the weight is negligible.
ModesVerdict JudgeModes(const JudgedModes& judged, RandomStream& rng, std::vector<ModeSpread>* spreads);

// The covariance of a mode by the option `covariance`, widened by the check and by uncertain intrinsics,
// before it is bounded by a uniform motion. `curvature`: InverseOfObserved. `of_intrinsics`:
// IntrinsicsCovariance.
Matrix5d ComputeModeCovariance(const ExplainedMode& mode, const Matrix5d& curvature,
                               const Matrix5d& of_intrinsics, const ModelCheck& check,
                               const MixturePrior& prior, const CalibratedOptions& options);

}  // namespace rcme
