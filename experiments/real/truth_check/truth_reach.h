// How far the given truth of a pair may be off and still be right, and the best motion within that reach.
#pragma once

#include <optional>
#include <vector>

#include "estimator/calibrated/mixture_fit.h"
#include "estimator/geometry/pose.h"
#include "estimator/motion_problem.h"
#include "experiments/data/truth_sd.h"
#include "experiments/study/study.h"

namespace rcme {

// What is given of a pair's motion.
struct GivenTruth {
  RelativePose cam2_from_cam1;
  std::optional<TruthSd> sd = std::nullopt;  // nothing: nobody says how good it is
  bool is_direction_known = true;            // false: only the rotation is given
};

// A truth that states its standard deviations reaches as far as their region of 99.9 %,
//
//   x' C^-1 x <= chi2_5(.999),   x the motion in the tangent at the truth (pose.h)
//
// One that does not reaches as far as the failure bounds: as long as any motion that would be scored as a
// success explains the matches, the truth is not to blame. A direction that is not given is anywhere.
class TruthReach {
 public:
  // `calibration_cov`, 5x5 [rotation, direction], rad^2: what uncertain intrinsics add to the stated errors.
  TruthReach(const GivenTruth& truth, const FailureBounds& bounds, const Matrix5d& calibration_cov);
  // The pose itself within the reach, else the last one on the way to it from the truth.
  RelativePose Clip(const RelativePose& pose) const;

 private:
  RelativePose truth_;
  Matrix5d inverse_cov_ = Matrix5d::Zero();  // zero: the bounds hold
  double max_rotation_rad_ = 0.0, max_direction_rad_ = 0.0;
};

// Whether a motion is beyond a bound of the truth.
bool IsBeyond(const FailureBounds& bounds, const GivenTruth& truth, const RelativePose& pose);

// The standard deviations of intrinsics that are allowed for: half a percent of the focal length and 2 px of
// the principal point, of either camera.
inline constexpr double kAllowedFocalSd = 0.005, kAllowedPrincipalPointSdPx = 2.0;
// What they make of a motion near `pose` (uncertainty/calibration_prior.h). Zero where the matches do not
// determine one.
Matrix5d AllowedCalibrationCovariance(const MotionProblem& problem, const RelativePose& pose,
                                      const MixtureParameters& mixture);

// The truth as it is given, and motions within its reach that explain the matches, where damped Newton steps
// of the mixture's likelihood, each clipped, lead: from the truth, straight, and with a scale of the
// residuals that falls from 32 times that of `mixture` to it, so that the first steps see motions several
// degrees away; and so from the end of the reach towards `towards`. The first is the truth; the others in no
// order.
std::vector<RelativePose> MoveTruth(const MatchBlocks& matches, const TruthReach& reach,
                                    const RelativePose& truth, const RelativePose& towards,
                                    const MixtureParameters& mixture);

}  // namespace rcme
