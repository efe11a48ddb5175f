// The source of a trial's matches, and what is known of the truth.
#pragma once

#include <cstdint>
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

// Each purpose has its own random stream in a trial, so streams share no numbers.
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
  kPopulation = 10,
  kPrior = 11
};

// Returns the stream of a trial for a purpose.
RandomStream StreamFor(StreamName trial_name, StreamPurpose purpose);

struct Truth {
  std::optional<RelativePose> cam2_from_cam1_true;
  bool is_direction_known = true;     // false: only the rotation is scored
  std::vector<bool> is_inlier_true;   // per match; empty: unknown
  std::vector<bool> is_undetectable;  // per match: wrong, but on the true epipolar line; empty: unknown
  // The uncertainty of the truth, part of the score. Nothing: exact, or not stated.
  std::optional<TruthSd> sd = std::nullopt;
  bool is_in_doubt = false;  // listed as wrong, so nothing is scored (truth_doubts.h)
};

// A problem for the estimators, and the truth for the score. The two stay apart from here on.
struct TrialData {
  MotionProblem problem;
  Truth truth;
  std::string origin;   // for people: the scene or file from which it comes
  double weight = 1.0;  // not 1 if the number of outliers was drawn by importance sampling (outlier_model.h)
  Severity severity;    // unknown for real pairs
  std::vector<std::uint32_t> scene_point;  // per match: index of its (original) point; empty: no scene
};

// Thrown if the simulator cannot make a trial with these settings; the message has the reason.
class NotSimulated : public InputError {
 public:
  using InputError::InputError;
};

// Makes all trials of one condition. Const, and shared by threads.
class DataSource {
 public:
  virtual ~DataSource() = default;
  // The number of trials of the condition if the study asks for `trials`.
  virtual int NumTrials(int trials) const = 0;
  // Makes a trial, a pure function of its name. Throws NotSimulated.
  virtual TrialData Make(const StreamName& trial_name) const = 0;
  // Other things on which the data depend (file contents), as text for the study's identity; empty: none.
  virtual std::string Identity() const { return {}; }
  // The parts of a simulation that are chosen by name (scene, cameras, ...), with their names; empty for
  // real pairs.
  virtual Settings ChosenParts() const { return {}; }
  // The exact scene of a trial; nothing if unknown.
  virtual std::optional<Scene> FindScene(const StreamName&) const { return std::nullopt; }
  // The real scene whose images all trials share; nothing if each trial draws its own scene.
  virtual std::optional<std::string> SharedScene() const { return std::nullopt; }
  // A name for each of its problems, the same wherever a problem is read from; empty for problems that are
  // drawn, which are known by their random stream.
  virtual std::vector<std::uint64_t> ProblemNames() const { return {}; }
};

}  // namespace rcme
