#pragma once

#include "estimator/inlier_quality.h"
#include "estimator/point_consistency.h"
#include "estimator/ransac_options.h"
#include "estimator/thresholds.h"

namespace rcme {

// RANSAC (Fischler & Bolles 1981): takes each motion as exact, tests neither samples nor inlier sets, and
// selects the motion with the most inliers.
struct InlierCountDecision {
  using PointTest = KnownPoseTest;
  static constexpr bool kTestsSample = false;
  InlierCountDecision(const RansacOptions&, const Thresholds&) {}
  bool AcceptsInlierSet(double) const { return true; }
  DecidingScore deciding_score() const { return DecidingScore::kNumInliers; }
};

}  // namespace rcme
