// Describes a run for readers of its results, in plain values and texts. Result files contain it, so reading
// them needs neither the estimators nor the data.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/core/text/program_name.h"
#include "experiments/study/study_plan.h"

namespace rcme {

struct DescribedCondition {
  std::vector<std::string> levels;  // one level per factor
  std::int64_t num_trials = 0;      // planned
};

struct DescribedEstimator {
  std::string label, name, effort;  // effort: as text (DescribeEffort)
  Settings options;                 // sorted by name
};

struct RunDescription {
  std::string study, description;  // name and description of the study
  Settings ademp;                  // the non-empty parts of its ADEMP block
  std::uint64_t seed = 1;
  int trials = 0;  // planned per condition; for a folder of pairs, passes over each pair
  int repeats_per_scene = 1;
  FailureBounds failure;
  std::vector<std::string> factors;
  std::vector<DescribedCondition> conditions;
  std::vector<DescribedEstimator> estimators;
  std::string study_yaml, identity;  // as in StudyPlan; needed to continue the run

  // If the number of trials depended on their outcomes: the rule, as text. Empty otherwise.
  std::string stopping_rule;
  // Options with which a single `rcme run` computes exactly these trials, `until_trials` in all; empty:
  // none.
  std::string until_options;
  std::int64_t until_trials = 0;
  // The text of the lock file (study_lock.h) with which the run began; empty: none. The reasons for
  // departing from it, one line for each time that the run was begun or continued so.
  std::string lock, despite_lock;
  std::int64_t retried_trials = 0;  // repeated because an answer from outside the program was missing
  // The shards of the study that the run has: "3/64" (core/work/shard.h), "1-3,7/64" after a merge,
  // "none/64" if every shard lacks trials; empty: the whole study.
  std::string shard;
  bool keeps_counts = false;  // only counts, not the trials themselves (run/store/counts_tables.h)
  TrialOrigin origin;         // of all trials; several names are separated by commas; empty: not known

  std::int64_t NumTrials() const;
};

// The stopping rule of `rcme run --until`.
inline constexpr const char* kUntilRule = "a rate's interval is narrow enough";

// Whether `rcme run --until` has never ended in this run, so that its target is not reached.
bool IsTargetOpen(const RunDescription& run);

// "10 of 12 trials done"; while the target is open, how many there will be is not known.
std::string DescribeProgress(std::int64_t num_done, std::int64_t num_planned, bool is_target_open);

// Describes a run that has not begun.
RunDescription Describe(const StudyPlan& plan);

// Returns the failure bounds as (name, text), such as ("max_rotation_error_deg", "3").
Settings ListBounds(FailureBounds bounds);

}  // namespace rcme
