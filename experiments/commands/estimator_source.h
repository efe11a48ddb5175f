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
  bool allow_process = false;          // allow the command that the file names
};

// Adds the options --estimator, --estimator-file, --conform, --set and --allow-process.
void AddEstimatorOptions(CLI::App* command, EstimatorChoice* choice);
// Adds the same, but with the command's own option or argument `name` in place of --estimator.
void AddEstimatorOptions(CLI::App* command, CLI::Option* name, EstimatorChoice* choice);

// The chosen estimator. Prints which command it allows. Throws InputError (estimator_file.h,
// estimator_spec.h).
EstimatorSpec ChosenEstimator(const EstimatorChoice& choice);

// The study's estimator with the label `name`, else an estimator by name or by estimator file. Throws
// InputError as ChosenEstimator does.
EstimatorSpec FindStudyEstimator(const Study& study, const std::string& name, bool allow_process);

// FindStudyEstimator, or with an empty name the study's only estimator. Throws InputError that begins with
// `command` if the study has several.
EstimatorSpec FindOnlyEstimator(const Study& study, const std::string& command, const std::string& name,
                                bool allow_process);

// Whether its options ask for `covariance: robust`.
bool HasRobustCovariance(const EstimatorSpec& spec);

}  // namespace rcme
