#pragma once

#include <memory>

#include "estimator/estimator_model.h"
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

// The paper's "Standard": RANSAC by inlier count with the noise-only threshold, then the Gold Standard
// refinement. It has no entropies and does not test its samples, so it lacks the options mu, quality_test,
// selection, early_stop_entropy, sample_significance_level and reading. The tests of the refined motion are
// off by default, as in the paper.
std::unique_ptr<EstimatorModel> StandardModel();

// The same from RansacOptions; leave early_stop_entropy off. Here the default levels of the tests of the
// refined motion depend on the reading. Throws InputError if options contradict each other.
std::unique_ptr<MotionEstimator> MakeStandard(const RansacOptions& options);

}  // namespace rcme
