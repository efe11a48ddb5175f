// Where the matches of a trial come from, and what is known of the truth.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "estimator/geometry/pose.h"
#include "estimator/motion_problem.h"
#include "experiments/data/settings.h"
#include "experiments/data/truth_sd.h"
#include "parameters/input_error.h"
#include "simulator/scene.h"
#include "simulator/severity/severity.h"
#include "stats/random.h"

namespace rcme {

// The random streams of a trial: one purpose each, so that none shares a number with another.
enum class StreamPurpose : std::uint32_t {
  kScene = 1,
  kNoise = 2,
  kOutliers = 3,
  kSampling = 4,
  kMonteCarlo = 5,
  kCheck = 6,
  kSeverity = 7,
  kPilotScene = 8,
  kTrueKind = 9,
  kPopulation = 10
};

// The stream of a trial for a purpose.
RandomStream StreamFor(StreamName trial_name, StreamPurpose purpose);

struct Truth {
  std::optional<RelativePose> cam2_from_cam1_true;
  bool is_direction_known = true;     // false: score the rotation alone
  std::vector<bool> is_inlier_true;   // per match; empty: unknown
  std::vector<bool> is_undetectable;  // per match: wrong, but on the true epipolar line; empty: none known
  // Its own error, part of the score; nothing: exact, or nobody says.
  std::optional<TruthSd> sd = std::nullopt;
  bool is_in_doubt = false;  // somebody lists it as wrong: nothing is scored (truth_doubts.h)
};

// A problem for the estimators and the truth for the score, kept apart from here on.
struct TrialData {
  MotionProblem problem;
  Truth truth;
  std::string origin;   // for people: the scene or the file it came from
  double weight = 1.0;  // of the trial, where its number of outliers is drawn by importance (outlier_model.h)
  Severity severity;    // unknown for real pairs
  std::vector<std::uint32_t> scene_point;  // per match, the one it is of or was of; empty: no scene
};

// The simulator cannot make a trial with these settings; the message says why.
class NotSimulated : public InputError {
 public:
  using InputError::InputError;
};

// All trials of one condition. Const and shared by threads.
class DataSource {
 public:
  virtual ~DataSource() = default;
  // Trials the condition has when the study asks for `trials`.
  virtual int NumTrials(int trials) const = 0;
  // A pure function of the name. Throws NotSimulated.
  virtual TrialData Make(const StreamName& trial_name) const = 0;
  // What else the data depend on (file contents), as text: part of the study's identity. Empty: nothing.
  virtual std::string Identity() const { return {}; }
  // The parts of a simulation that are chosen by name (scene, cameras, ...) with the names; empty: real
  // pairs.
  virtual Settings ChosenParts() const { return {}; }
  // The exact scene of a trial; nothing where nobody knows it.
  virtual std::optional<Scene> FindScene(const StreamName&) const { return std::nullopt; }
  // The real scene whose images all trials share, again and again; nothing: each trial draws its own.
  virtual std::optional<std::string> SharedScene() const { return std::nullopt; }
};

}  // namespace rcme
