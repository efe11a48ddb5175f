// Groups the trials of a run for a summary.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/run/store/result_store.h"

namespace rcme {

struct TrialGroups {
  std::vector<std::string> factor_names;
  std::vector<std::vector<std::string>> levels;  // of every group, one level per factor
  std::function<size_t(const ProblemRecord&)> group_of;
  bool is_in_order = false;  // trials ordered by condition and trial come group after group
};

enum class Pooling { kPerCondition, kPooled };

TrialGroups GroupByCondition(const RunDescription& run);
TrialGroups OneGroup();

// Groups all conditions of a draw of a population, whatever the levels of their factors; these depend on
// each other, draws do not. Throws std::logic_error for a run without draws.
TrialGroups GroupByDraw(const RunDescription& run);

// Returns the number of each condition's draw (GroupByDraw), or the condition's own number without draws.
std::vector<size_t> NumberDraws(const RunDescription& run);

// Finds trials that depend on each other: those of a draw if the conditions are a sample of a population,
// otherwise those of a scene. If conditions share their scenes, trials with the same number share a scene.
class TrialClusters {
 public:
  explicit TrialClusters(const RunDescription& run);
  std::int64_t Find(const ProblemRecord& problem) const;
  // Of trials that share their scene, also where Find gives the draw.
  std::int64_t FindScene(const ProblemRecord& problem) const;

 private:
  std::optional<TrialGroups> draws_;
  std::uint32_t repeats_per_scene_;
  std::int64_t conditions_apart_;
};

// Makes five groups with equally many trials, by a number of the problem (kSeverityColumns:
// "crb_direction_deg"), least values first. Equal values are in one group; trials for which the number is
// unknown form a sixth. Reads the run once. Throws InputError if there is no such number, or if it is
// unknown for all trials.
TrialGroups GroupByFifth(const ResultStore& store, const std::string& quantity);

}  // namespace rcme
