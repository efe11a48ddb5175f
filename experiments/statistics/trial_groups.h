// How the trials of a run are put together for a summary.
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
  std::vector<std::vector<std::string>> levels;  // of every group, one per factor
  std::function<size_t(const ProblemRecord&)> group_of;
  bool is_in_order = false;  // the trials of a run, by condition and trial, come group after group
};

enum class Pooling { kPerCondition, kPooled };

TrialGroups GroupByCondition(const RunDescription& run);
TrialGroups OneGroup();

// The conditions of a draw of a population, whatever their levels of factors: they are alike, draws are not.
// Throws std::logic_error for a run without draws.
TrialGroups GroupByDraw(const RunDescription& run);

// Of each condition the number of its draw (GroupByDraw), or its own where there are no draws.
std::vector<size_t> NumberDraws(const RunDescription& run);

// Which trials depend on each other: those of a draw, where the conditions are a sample of a population, else
// those of a scene. Conditions that share their scenes have one scene per number of a trial.
class TrialClusters {
 public:
  explicit TrialClusters(const RunDescription& run);
  std::int64_t Find(const ProblemRecord& problem) const;

 private:
  std::optional<TrialGroups> draws_;
  std::uint32_t repeats_per_scene_;
  std::int64_t conditions_apart_;
};

// Five groups with equally many trials, those with the least value of a number of the problem first
// (kSeverityColumns: "crb_direction_deg"); equal values are in one group, and the trials of which it is
// unknown in a sixth. Reads the run once. Throws InputError if there is no such number, or it is unknown of
// all.
TrialGroups GroupByFifth(const ResultStore& store, const std::string& quantity);

}  // namespace rcme
