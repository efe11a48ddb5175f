// A simulated study that resembles a set of real pairs: in what it is fitted, and what it is made of.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "estimator/motion_estimator.h"
#include "experiments/data/data_source.h"
#include "experiments/data/match_folder.h"
#include "experiments/study/study.h"

namespace rcme {

// A real pair with an answer to it and, where its geometry is known well enough, its exact template: the
// right matches (those that the answer accepts, or that are near) moved onto the reference motion, which is
// the template's truth; the wrong ones as they are. The reference is the answer, or, where that fails by the
// given truth or there is none, the given truth.
struct AnsweredTrial {
  TrialData pair;
  std::string image1, image2;  // empty: not known
  MotionEstimate estimate;
  std::optional<TrialData> exact;
};
// Matches within this many standard deviations of the reference count as right.
inline constexpr double kRightWithin = 4.0;

struct TwinSource {
  std::string scene;
  std::vector<AnsweredTrial> pairs;
};
// Of every pair of a real scene. Pure in the seed and the pairs' names.
TwinSource AnswerScene(const std::string& scene, const DataSource& data, const ImageNames& images,
                       const MotionEstimator& estimator, std::uint64_t seed);

// What is measured on a scene. Medians over pairs, where nothing else is said.
struct TwinFit {
  int num_templates = 0;
  // Noise, fitted such that redrawn templates give the estimator the residuals that the pairs give it: their
  // size, the ratio of their 95 % point to their median, their correlation up to 1 px and beyond.
  RedrawSettings noise;
  Camera camera1, camera2;  // of the first pair
  int num_matches = 0;
  double wrong_share = 0.0;           // mean over pairs
  double wrong_agreeing_share = 0.0;  // of the wrong: another one within 30 px moves alike, to 10 px
  double rotation_deg = 0.0, parallax_deg = 0.0;
  double forwardness = 0.0;              // |t_z|
  double nearest = 0.0, farthest = 0.0;  // 5 % and 95 % points of all depths, in baselines
  double homography_share = 0.0;         // of the right matches: one homography explains them
  double clark_evans = 0.0;              // of the right key points in image 1: 1 random, less: clustered
  double twice_share = 0.0;              // of the right matches: another is within 1 px in image 1
};
// Throws InputError where no pair of the scene has a template.
TwinFit FitTwin(const TwinSource& source, const MotionEstimator& estimator, std::uint64_t seed);

// Data blocks of studies: the real layout, noise and wrong matches drawn anew (`folder`: that of the
// templates); and a simulated scene, whose keys are fitted to the same numbers. The second throws InputError
// where no scene of its kind has the parallax that was measured.
Settings SemiRealData(const TwinFit& fit, const std::string& folder, double assumed_sigma_px);
Settings SimulatedTwinData(const TwinFit& fit, double assumed_sigma_px);

}  // namespace rcme
