// The reach of a pair's given truth: how far it may be off and still count as right. Finds the best motion
// within it.
#pragma once

#include <optional>
#include <vector>

#include "estimator/calibrated/mixture_fit.h"
#include "estimator/geometry/pose.h"
#include "estimator/motion_problem.h"
#include "experiments/data/truth_sd.h"
#include "experiments/study/study.h"

namespace rcme {

// The given motion of a pair.
struct GivenTruth {
  RelativePose cam2_from_cam1;
  std::optional<TruthSd> sd = std::nullopt;  // empty: not stated
  bool is_direction_known = true;            // false: only the rotation is given
};

// The reach of a truth that states its standard deviations is their 99.9 % region,
//
//   x' C^-1 x <= chi2_5(.999),   x the motion in the tangent at the truth (pose.h)
//
// Otherwise, or if only the rotation is given, it is the region within the failure bounds: as long as any
// motion that would be scored as a success explains the matches, the truth is not to blame. A direction that
// is not given may be anything.
class TruthReach {
 public:
  // `calibration_cov`, 5x5 [rotation, direction], rad^2: the contribution of uncertain intrinsics, added to
  // the stated covariance.
  TruthReach(const GivenTruth& truth, const FailureBounds& bounds, const Matrix5d& calibration_cov);
  // Returns the pose if it is within the reach, else the last pose within the reach on the way from the
  // truth.
  RelativePose Clip(const RelativePose& pose) const;

 private:
  RelativePose truth_;
  Matrix5d inverse_cov_ = Matrix5d::Zero();  // zero: the failure bounds apply
  double max_rotation_rad_ = 0.0, max_direction_rad_ = 0.0;
};

// Returns whether a motion is beyond a bound of the truth.
bool IsBeyond(const FailureBounds& bounds, const GivenTruth& truth, const RelativePose& pose);

// The assumed standard deviations of intrinsics: half a percent of the focal length and 2 px of the
// principal point, for each camera.
inline constexpr double kAllowedFocalSd = 0.005, kAllowedPrincipalPointSdPx = 2.0;
// Returns their effect on a motion near `pose` (uncertainty/calibration_prior.h). Zero if the matches do not
// determine a motion.
Matrix5d AllowedCalibrationCovariance(const MotionProblem& problem, const RelativePose& pose,
                                      const MixtureParameters& mixture);

// Returns the given truth, followed by motions within its reach that explain the matches better. These are
// found by damped Newton steps of the mixture's likelihood, each clipped: from the truth with the scale of
// `mixture`; from the truth with a scale that falls from 32 times that of `mixture`, so that the first steps
// see motions several degrees away; and with the same falling scale from the end of the reach in the
// direction of `towards`.
std::vector<RelativePose> MoveTruth(const MatchBlocks& matches, const TruthReach& reach,
                                    const RelativePose& truth, const RelativePose& towards,
                                    const MixtureParameters& mixture);

}  // namespace rcme
