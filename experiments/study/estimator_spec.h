#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "estimator/estimator_model.h"
#include "parameters/settings.h"

namespace rcme {

// One estimator of a study. In a result file it may be one that this program does not know.
struct EstimatorSpec {
  std::string label;  // unique in the study; what tables and plots show
  std::string name;   // in the estimator registry
  Settings options;   // every option that the estimator has, with its value as the option itself writes it
  std::optional<double> budget_ms;  // the time of a call that its effort was chosen for (rcme budget)
  // "study.yaml:7": where its command stands, if a file brought one that nobody has allowed
  // (command_permission.h).
  std::string command_place = {};
};

// An estimator with its default options, labelled by its name. Throws InputError that lists the known names.
EstimatorSpec DefaultEstimator(const std::string& name);

// Gives options other values. Throws InputError that lists the options the estimator has, or what is allowed.
void SetOptions(EstimatorSpec* spec, const Settings& options);

// The options of the estimator `answers` for a file: with the digest of its content. Throws InputError for a
// file that holds no answers.
Settings AnswersOptions(const std::string& path);

// The estimator that one called `conform` wraps, from its file; nothing for another. Throws InputError as
// ReadConformFile.
std::optional<EstimatorSpec> FindConformed(const EstimatorSpec& spec);

// What limits the work of a call, in words: "num_iterations 200", "3.1 ms a call (num_iterations 1840)",
// "own rule, max_iterations 5000"; empty: nobody knows.
std::string DescribeEffort(const EstimatorSpec& spec);

// Throws InputError where the command of an estimator that is a process is not allowed (command_permission.h)
// or cannot be used (RequireCommandAnswers of peers/peer_registry.h). To be called before work that is asked
// of these estimators begins.
void CheckProcessEstimators(const std::vector<EstimatorSpec>& specs);

// The estimator, configured or made. Throw InputError as ConfigureEstimator does; Make also for a command
// that nobody has allowed.
std::unique_ptr<EstimatorModel> Configure(const EstimatorSpec& spec);
std::unique_ptr<MotionEstimator> Make(const EstimatorSpec& spec);

}  // namespace rcme
