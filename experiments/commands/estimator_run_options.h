// The options of the commands that run one estimator on the problems of a study: `rcme conform` and `rcme
// integrity`.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "experiments/commands/shard_options.h"
#include "experiments/commands/study_source.h"

namespace rcme {

struct EstimatorRunArguments {
  std::string study, estimator, out;  // estimator empty: the study's only one
  std::int64_t trials = -1;           // per condition; negative: the study's number
  int threads = 0;                    // 0: one per core
  StudyChanges changes;
  ShardArguments shards;
};

// Adds the positional argument of the study, which is returned, and --estimator.
CLI::Option* AddStudyAndEstimator(CLI::App* command, EstimatorRunArguments* arguments);

void AddTrialsOption(CLI::App* command, EstimatorRunArguments* arguments);

// Adds the options of study_source.h and shard_options.h, --allow-process and --threads.
void AddRunOptions(CLI::App* command, EstimatorRunArguments* arguments);

}  // namespace rcme
