#pragma once

#include "estimator/inlier_quality.h"
#include "estimator/point_consistency.h"
#include "estimator/ransac_options.h"
#include "estimator/thresholds.h"

namespace rcme {

// RANSAC (Fischler & Bolles 1981): motions taken as exact, no test of samples or inlier sets, most inliers
// win.
struct InlierCountDecision {
  using PointTest = KnownPoseTest;
  static constexpr bool kTestsSample = false;
  InlierCountDecision(const RansacOptions&, const Thresholds&) {}
  bool AcceptsInlierSet(double) const { return true; }
  DecidingScore deciding_score() const { return DecidingScore::kNumInliers; }
};

}  // namespace rcme
