// Selects key-frame pairs by the test of ORB-SLAM2's initializer (Mur-Artal, Montiel & Tardos 2015, section
// IV; the program's Tracking.cc and Initializer.cc), with which the paper chose its pairs. It does not use
// the truth.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "estimator/model_choice/verdict.h"
#include "estimator/motion_problem.h"

namespace rcme {

// Without a criterion every pair is kept. Otherwise a pair is kept if
//
//   - it has at least least_matches matches (100, as in the program);
//   - the criterion chooses the epipolar geometry: not a homography (planar_scene), not a rotation, and
//     enough matches show parallax beyond the noise (verdict.h). These are the degeneracies of Torr,
//     Fitzgibbon & Zisserman 1999;
//   - for one of its four motions, at least 90 % of the matches that agree with it, and at least 50, lie in
//     front of both cameras;
//   - the 50th largest angle between the two rays of a match exceeds least_parallax_deg (1 degree).
struct KeyFrameGate {
  std::optional<ModelCriterion> criterion = ModelCriterion::kOrbSlam2;  // empty: every pair is kept
  int least_matches = 100;
  double least_parallax_deg = 1.0;
  double sigma_px = 0.5;  // noise level that the criterion assumes
};

struct KeyFrameVerdict {
  std::string reason;  // "kept", or which condition failed, such as "too_few_matches"
  std::optional<int> num_inliers = std::nullopt;  // of the chosen model; none if no model was fitted
  double parallax_deg = std::numeric_limits<double>::quiet_NaN();  // the 50th largest; NaN: not computed
};
inline const std::string kKeptPair = "kept", kTooFewMatches = "too_few_matches";

// A pure function of the problem and the name of the stream.
KeyFrameVerdict JudgePair(const MotionProblem& problem, const KeyFrameGate& gate, RandomStream& rng);

}  // namespace rcme
