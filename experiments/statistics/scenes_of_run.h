// The trials of a run, scene by scene: where scenes are repeated (Study::repeats_per_scene), the repeats of
// one are not independent, and what is said of trials is said of scenes.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "experiments/statistics/readable_run.h"

namespace rcme {

// The mean over the trials of a scene that give a number.
class SceneMean {
 public:
  void Add(double x) { sum_ += x, ++count_; }
  // And begins the next scene. Nothing where no trial gave one.
  std::optional<double> Take();

 private:
  double sum_ = 0.0;
  int count_ = 0;
};

// Whether trials of the same number share their scene in all conditions (Study::common_scenes).
bool HasCommonScenes(const RunDescription& run);

// Calls `visit` for every trial of the run, ordered by condition and trial, and `end_of_scene` with the
// condition after the last trial of each scene. `is_first`: of its scene; a run that was cut off may lack
// it.
void ForEachTrialByScene(
    const ReadableRun& run,
    const std::function<void(const ProblemRecord&, const std::vector<TrialRecord>&, bool is_first)>& visit,
    const std::function<void(std::uint32_t condition)>& end_of_scene);

}  // namespace rcme
