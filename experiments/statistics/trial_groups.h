// How the trials of a run are put together for a summary.
#pragma once

#include <functional>
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

// Five groups with equally many trials, those with the least value of a number of the problem first
// (kSeverityColumns: "crb_direction_deg"); equal values are in one group, and the trials of which it is
// unknown in a sixth. Reads the run once. Throws InputError if there is no such number, or it is unknown of
// all.
TrialGroups GroupByFifth(const ResultStore& store, const std::string& quantity);

}  // namespace rcme
