// What a reader of results has to know of a run, in plain values and texts: a result file holds it, and no
// estimator and no data are needed to read it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/core/text/program_name.h"
#include "experiments/data/settings.h"
#include "experiments/study/study_plan.h"

namespace rcme {

struct DescribedCondition {
  std::vector<std::string> levels;  // one per factor
  std::int64_t num_trials = 0;      // asked for
};

struct DescribedEstimator {
  std::string label, name, effort;  // the last in words (DescribeEffort)
  Settings options;                 // by name
};

struct RunDescription {
  std::string study, description;  // its name, and its own words
  Settings ademp;                  // the parts of its ADEMP block that are not empty
  std::uint64_t seed = 1;
  int trials = 0;  // asked for per condition; for a folder of pairs, passes over each pair
  int repeats_per_scene = 1;
  FailureBounds failure;
  std::vector<std::string> factors;
  std::vector<DescribedCondition> conditions;
  std::vector<DescribedEstimator> estimators;
  std::string study_yaml, identity;  // as in StudyPlan: for who runs the study

  // Not empty: the number of trials depended on their outcomes, in these words.
  std::string stopping_rule;
  // Options of `rcme run` that alone gave `until_trials` trials in all; empty: none.
  std::string until_options;
  std::int64_t until_trials = 0;
  // The text of the lock file (study_lock.h) that the run was begun with, empty: none; and why the study
  // departs from it, a line each time that a run was begun or continued so.
  std::string lock, despite_lock;
  std::int64_t retried_trials = 0;  // run again because an answer from outside the program was missing
  // Which shards of the study: "3/64" (core/work/shard.h), of several that were merged "1-3,7/64", "none/64"
  // if every one of them lacks trials; empty: all of it.
  std::string shard;
  bool keeps_counts = false;  // of the trials, not the trials themselves (run/store/counts_tables.h)
  TrialOrigin origin;         // of all trials; several names are separated by commas, none known is empty

  std::int64_t NumTrials() const;
};

// Of a run that has not begun.
RunDescription Describe(const StudyPlan& plan);

// The failure bounds, one by one, as (name, text): "max_rotation_error_deg", "3".
Settings ListBounds(FailureBounds bounds);

}  // namespace rcme
