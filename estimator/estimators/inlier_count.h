#pragma once

#include "estimator/point_consistency.h"
#include "estimator/ransac_loop.h"

namespace rcme {

// RANSAC (Fischler & Bolles 1981): motions taken as exact, no test of samples or inlier sets, most inliers
// win.
struct InlierCountPipeline {
  using PointTest = KnownPoseTest;
  static constexpr bool kTestsSample = false;
  static bool InlierSetIsGood(double, const RansacOptions&, const Thresholds&) { return true; }
  static bool IsBetter(const InlierScore& a, const InlierScore& b, const RansacOptions&) {
    return a.num_inliers > b.num_inliers;
  }
};

}  // namespace rcme
