// The noise, layout and motion of a scene to which its simulated twin is fitted.
#pragma once

#include "experiments/data/redraw.h"
#include "experiments/real/truth_free/twin_source.h"

namespace rcme {

// Measurements on a scene; medians over pairs unless stated otherwise.
struct TwinFit {
  int num_templates = 0;
  RedrawSettings noise;            // of the semi-real twin (noise_fit.h)
  RedrawSettings simulated_noise;  // of the simulated twin: size, tails and correlation of neighbours
  Camera camera1, camera2;         // of the first pair
  int num_matches = 0;
  double wrong_share = 0.0;           // mean over pairs
  double wrong_agreeing_share = 0.0;  // of wrong matches with another within 30 px that moves alike to 10 px
  double rotation_deg = 0.0, parallax_deg = 0.0;
  double forwardness = 0.0;              // |t_z|
  double nearest = 0.0, farthest = 0.0;  // 5 % and 95 % points of all depths, in baselines
  double homography_share = 0.0;         // of right matches that one homography explains
  double clark_evans = 0.0;  // index of the right key points in image 1; 1: random, less: clustered
};
// The noise is fitted in steps (noise_fit.h). Throws InputError if no pair of the scene has a template.
TwinFit FitTwin(const TwinSource& source, const MotionEstimator& estimator, std::uint64_t seed,
                KeptSteps* steps = nullptr);

}  // namespace rcme
