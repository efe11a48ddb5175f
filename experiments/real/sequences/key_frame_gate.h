// Which pairs are key frames: the test of ORB-SLAM2's initialiser (Mur-Artal, Montiel & Tardos 2015, section
// IV; Tracking.cc and Initializer.cc of the program), by which the paper chose its pairs. Truth plays no
// part.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "estimator/model_choice/verdict.h"
#include "estimator/motion_problem.h"

namespace rcme {

// A pair is kept where
//
//   - it has least_matches matches (100, as the program);
//   - the criterion chooses the epipolar geometry: not a homography (planar_scene), not a rotation, and
//   enough matches
//     show parallax beyond the noise (verdict.h): neither degeneracy of Torr, Fitzgibbon & Zisserman 1999;
//   - of the matches that agree with it, at least 90 % and 50 lie in front of both cameras for one of its
//   four motions;
//   - the 50th largest angle between the two rays of a match is more than least_parallax_deg (1 degree).
struct KeyFrameGate {
  std::optional<ModelCriterion> criterion = ModelCriterion::kOrbSlam2;  // nothing: every pair is kept
  int least_matches = 100;
  double least_parallax_deg = 1.0;
  double sigma_px = 0.5;  // noise that the criterion assumes
};

struct KeyFrameVerdict {
  std::string reason;  // "kept", or why not: a word of the list above
  int num_inliers = 0;
  double parallax_deg = std::numeric_limits<double>::quiet_NaN();  // the 50th largest; NaN: not looked at
};
inline const std::string kKeptPair = "kept", kTooFewMatches = "too_few_matches";

// A pure function of the problem and the stream's name.
KeyFrameVerdict JudgePair(const MotionProblem& problem, const KeyFrameGate& gate, RandomStream& rng);

}  // namespace rcme
