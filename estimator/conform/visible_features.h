// Features of a problem and its answer that are visible without the truth and show how hard the problem is.
// conform_rule.h uses them to widen regions, to correct probabilities and to notice a shift.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"

namespace rcme {

enum class VisibleFeature {
  kMatches,        // log(1 + matches)
  kAgreeing,       // log(1 + matches that agree with the motion at the assumed sigma)
  kAgreeingShare,  // log-odds of their share, with one added on either side
  // log of the residuals' scale, median |Sampson distance| / .6745 of the estimator's inliers, over the
  // assumed sigma; a ratio of at least .001
  kResidual,
  // log of the median parallax over its noise: residuals of the agreeing matches under the rotation alone,
  // over sqrt(2) sigma; a ratio of at least .001
  kParallax,
  // log-odds of the share of agreeing matches that one homography explains, with one added on either side
  kPlanarity,
  kSpread,       // log of the standard deviation of agreeing points of image 1 over the focal length
  kRotation,     // log(.1 + rotation, deg)
  kAxialShare,   // |t_z|
  kRotationSd,   // log of the stated standard deviation of the rotation (root of the trace), rad
  kDirectionSd,  // likewise for the direction
  kStatedOdds,   // log-odds of the stated probability of failure, clipped to [1e-4, 1 - 1e-4]
};
inline constexpr size_t kNumVisibleFeatures = 12;

// In the order of the enumeration; NaN: the answer does not have the feature.
using VisibleFeatures = std::array<double, kNumVisibleFeatures>;

// "matches", "agreeing", ...
const std::vector<std::string>& VisibleFeatureNames();

// Measures the features of an answer with a motion (status ok) whose numbers are finite; for another answer,
// all but the number of matches are NaN. A pure function; takes about 0.1 ms for 500 matches.
VisibleFeatures MeasureVisibleFeatures(const MotionProblem& problem, const MotionEstimate& estimate);

}  // namespace rcme
