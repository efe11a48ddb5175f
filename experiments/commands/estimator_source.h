// The estimator of a command: by name or from a file, with the changes of the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/study/study.h"

namespace rcme {

struct EstimatorChoice {
  std::string name = "rcme_calibrated";
  std::optional<std::string> file, conform;
  std::vector<std::string> overrides;  // option=value each
  bool allow_process = false;          // the command of the file
};

// The options --estimator, --estimator-file, --conform, --set and --allow-process.
void AddEstimatorOptions(CLI::App* command, EstimatorChoice* choice);
// The same where `name`, the command's own option or argument, stands in the place of --estimator.
void AddEstimatorOptions(CLI::App* command, CLI::Option* name, EstimatorChoice* choice);

// Throws InputError (estimator_file.h, estimator_spec.h). Says which command it allows.
EstimatorSpec ChosenEstimator(const EstimatorChoice& choice);

// The estimator of the study with this label, or one by its name or estimator file. Throws InputError as
// ChosenEstimator.
EstimatorSpec FindStudyEstimator(const Study& study, const std::string& name, bool allow_process);

// The same, or without a name the study's only one. Throws InputError that begins with `command` if it has
// several.
EstimatorSpec FindOnlyEstimator(const Study& study, const std::string& command, const std::string& name,
                                bool allow_process);

// Whether its options ask for `covariance: robust`.
bool HasRobustCovariance(const EstimatorSpec& spec);

}  // namespace rcme
