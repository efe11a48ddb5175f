#include "experiments/statistics/scenes_of_run.h"

#include <utility>

#include "parameters/input_error.h"

namespace rcme {

std::optional<double> SceneMean::Take() {
  const SceneMean whole = std::exchange(*this, SceneMean());
  if (whole.count_ == 0) return std::nullopt;
  return whole.sum_ / whole.count_;
}

bool HasCommonScenes(const RunDescription& run) {
  // As ToYaml writes the key; a description does not begin a line with it.
  return run.study_yaml.find("\ncommon_scenes: true") != std::string::npos;
}

void CheckMayBePooled(const RunDescription& run) {
  if (run.conditions.size() < 2) return;
  if (!run.stopping_rule.empty())
    throw InputError(
        "the outcomes decided how many trials each condition has (--until), so a rate over all conditions would depend "
        "on that; leave --pooled and --fifths-of out, or run the study with a fixed number of trials");
  if (!HasCommonScenes(run)) return;
  throw InputError(
      "the conditions share their scenes (common_scenes: true), so their trials are not independent and an interval "
      "over all of them would be too short; leave --pooled and --fifths-of out");
}

void ForEachTrialByScene(
    const ReadableRun& run,
    const std::function<void(const ProblemRecord&, const std::vector<TrialRecord>&, bool is_first)>& visit,
    const std::function<void(std::uint32_t condition)>& end_of_scene) {
  using SceneId = std::pair<std::uint32_t, std::uint32_t>;  // condition, scene
  std::optional<SceneId> current;
  const auto repeats = static_cast<std::uint32_t>(run.description.repeats_per_scene);
  run.for_each_trial([&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
    const SceneId scene(problem.condition, problem.trial / repeats);
    if (current && *current != scene) end_of_scene(current->first);
    current = scene;
    visit(problem, records, problem.trial % repeats == 0);
  });
  if (current) end_of_scene(current->first);
}

}  // namespace rcme
