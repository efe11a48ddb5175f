// Matches with a known motion, and the mode of rcme_calibrated that a fit from the truth reaches.
#pragma once

#include <algorithm>
#include <cmath>

#include "estimator/calibrated/explanation.h"
#include "estimator/calibrated/mixture_fit.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {

// As RcmeCalibrated takes it: the density of a wrong match over half the diagonal of image 2.
inline MixturePrior MakePrior(const MotionProblem& problem) {
  return {2.0 * problem.sigma_px / std::hypot(problem.camera2.width, problem.camera2.height), true};
}

// All matches, at `pose`, before any step.
inline Mode StartMode(const MatchBlocks& matches, const MixturePrior& prior, const RelativePose& pose,
                      double scale = NoiseLaw().scale_of_gaussian) {
  Mode mode;
  mode.pose = pose;
  mode.used = matches.All();
  mode.mixture = FirstGuess(prior, scale, 0.7);
  return mode;
}

struct FittedMode {
  MotionProblem problem;
  RelativePose pose_true;
  MatchBlocks matches;
  MixturePrior prior;
  Mode mode;
  bool has_converged;
};

inline FittedMode FitFromTruth(const MotionProblem& problem, const RelativePose& pose_true) {
  const MatchBlocks matches(problem);
  const MixturePrior prior = MakePrior(problem);
  FittedMode fitted{problem, pose_true, matches, prior, StartMode(matches, prior, pose_true), false};
  fitted.has_converged = FitMode(matches, prior, 50, &fitted.mode);
  return fitted;
}

// A TwoCameraProblem of this noise whose assumed sigma is `assumed_factor` times the true one.
inline FittedMode FitScene(int num_matches, double sigma_px, double outlier_ratio, std::uint32_t trial,
                           double assumed_factor = 1.0) {
  RelativePose pose_true;
  MotionProblem problem = TwoCameraProblem(num_matches, sigma_px, outlier_ratio, trial, &pose_true);
  problem.sigma_px *= assumed_factor;
  return FitFromTruth(problem, pose_true);
}

}  // namespace rcme
