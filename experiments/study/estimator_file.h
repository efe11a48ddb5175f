// An estimator with its options in a file of its own, such as a tuned estimator:
//
//   name: rcme
//   label: rcme_tuned
//   options: {reading: rank_aware, mu: 5.25, lambda: 0.6}
//   provenance: {study: tune_mu_lambda, seed: 1, verified: "..."}   # any keys and texts, kept for people
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/study/study.h"

namespace rcme {

// Where an estimator comes from, as texts for people; each key occurs once.
using Provenance = std::vector<std::pair<std::string, std::string>>;

// Reads and validates an estimator file, given by its path or by the name of one that is installed with the
// program (core/files/shared_files.h). Throws InputError as LoadStudy does.
EstimatorSpec LoadEstimatorFile(const std::string& name);

// The same from text; messages call it `path`.
EstimatorSpec ParseEstimatorFile(const std::string& yaml, const std::string& path);

// Returns the name of the installed estimator file with this label, as tables of results print it: nullopt if
// there is none.
std::optional<std::string> FindInstalledFile(const std::string& label);

// Returns the estimator that a file of `rcme conform` wraps. A command of it counts as one from that file
// (command_permission.h). Throws InputError as ReadConformFile does.
EstimatorSpec LoadConformedEstimator(const std::string& path);

// Formats an estimator file with the value of every option, defaults included. ParseEstimatorFile returns
// the same estimator.
std::string EstimatorFileText(const EstimatorSpec& spec, const Provenance& provenance);

}  // namespace rcme
