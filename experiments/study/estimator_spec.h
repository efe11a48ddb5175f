#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "estimator/estimator_model.h"
#include "parameters/settings.h"

namespace rcme {

// One estimator of a study. Result files may have estimators that this program does not know.
struct EstimatorSpec {
  std::string label;                // unique in the study; shown in tables and plots
  std::string name;                 // in the estimator registry
  Settings options;                 // value of every option of the estimator, formatted by the option
  std::optional<double> budget_ms;  // time per call that set its effort (rcme budget)
  // The place of its command, such as "study.yaml:7", if the command comes from a file and has not been
  // allowed (command_permission.h).
  std::string command_place = {};
};

// Returns an estimator with default options whose label is its name. Throws InputError that lists the known
// names.
EstimatorSpec DefaultEstimator(const std::string& name);

// Returns whether the estimator's answers come from outside the program: `process`, `answers` or `python`.
// They need not state a covariance (peers/outside_answer.h).
bool IsOutside(const std::string& name);

// Changes options. Throws InputError that lists the estimator's options, or what a value may be.
void SetOptions(EstimatorSpec* spec, const Settings& options);

// Returns the options of the estimator `answers` for a file, with the digest of its content. Throws
// InputError if the file does not contain answers.
Settings AnswersOptions(const std::string& path);

// Returns the estimator that an estimator `conform` wraps, read from its file; nothing for other estimators.
// Throws InputError as ReadConformFile does.
std::optional<EstimatorSpec> FindConformed(const EstimatorSpec& spec);

// Describes what limits the work of a call: "num_iterations 200", "3.1 ms a call (num_iterations 1840)",
// "own rule, max_iterations 5000". Empty if not known.
std::string DescribeEffort(const EstimatorSpec& spec);

// Checks the estimators that are processes; call this before their first work. Throws InputError if a
// command is not allowed (command_permission.h) or does not work (RequireCommandAnswers in
// peers/peer_registry.h).
void CheckProcessEstimators(const std::vector<EstimatorSpec>& specs);

// Returns the configured model, or the estimator itself. Both throw InputError as ConfigureEstimator does;
// Make also throws if the command has not been allowed.
std::unique_ptr<EstimatorModel> Configure(const EstimatorSpec& spec);
std::unique_ptr<MotionEstimator> Make(const EstimatorSpec& spec);

// The labels of estimators: of EstimatorSpec, DescribedEstimator or another type with a label.
template <typename Estimator>
std::vector<std::string> ListLabels(const std::vector<Estimator>& estimators) {
  std::vector<std::string> labels;
  for (const Estimator& estimator : estimators) labels.push_back(estimator.label);
  return labels;
}

// Finds an estimator of a study or a run by its label: returns the index of `label` in `labels`. Throws
// InputError that begins with `owner` ("--estimator: the study") and lists the labels.
size_t FindLabel(const std::vector<std::string>& labels, const std::string& label, const std::string& owner);

template <typename Estimator>
size_t FindEstimator(const std::vector<Estimator>& estimators, const std::string& label,
                     const std::string& owner) {
  return FindLabel(ListLabels(estimators), label, owner);
}

}  // namespace rcme
