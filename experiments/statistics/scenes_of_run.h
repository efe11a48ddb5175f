// Visits the trials of a run scene by scene. The repeats of a scene (Study::repeats_per_scene) depend on
// each other, so statistics then count scenes instead of trials.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "experiments/statistics/readable_run.h"

namespace rcme {

// The mean over those trials of a scene that have a value.
class SceneMean {
 public:
  void Add(double x) { sum_ += x, ++count_; }
  // Returns the mean, or nothing if no trial had a value, and begins the next scene.
  std::optional<double> Take();

 private:
  double sum_ = 0.0;
  int count_ = 0;
};

// Returns whether trials with the same number share their scene in all conditions (Study::common_scenes).
bool HasCommonScenes(const RunDescription& run);

// Throws InputError if trials of several conditions cannot be pooled. A stopping rule gives more trials to
// conditions whose rate is hard to measure, so a rate over all would depend on the rule. Exact intervals need
// independent trials, but conditions may share their scenes; a population's intervals are of its draws.
void CheckMayBePooled(const RunDescription& run);

// Calls `visit` for every trial of the run, ordered by condition and trial, and `end_of_scene` with the
// condition after the last trial of each scene. `is_first`: the trial is the first of its scene, which an
// interrupted run may lack.
void ForEachTrialByScene(
    const ReadableRun& run,
    const std::function<void(const ProblemRecord&, const std::vector<TrialRecord>&, bool is_first)>& visit,
    const std::function<void(std::uint32_t condition)>& end_of_scene);

}  // namespace rcme
