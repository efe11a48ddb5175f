// An estimator with its options as a file of its own, such as a tuned one:
//
//   name: rcme
//   label: rcme_tuned
//   options: {reading: rank_aware, mu: 5.25, lambda: 0.6}
//   provenance: {study: tune_mu_lambda, seed: 1, verified: "..."}   # any keys and texts, kept for people
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiments/study/study.h"

namespace rcme {

// Where an estimator comes from, in the words of whoever wrote its file; each key once.
using Provenance = std::vector<std::pair<std::string, std::string>>;

// Reads and validates an estimator file: a path, or the name of one that comes with the program
// (core/files/shared_files.h). Throws InputError as LoadStudy does.
EstimatorSpec LoadEstimatorFile(const std::string& name);

// The same from text; `path` is what the messages call it.
EstimatorSpec ParseEstimatorFile(const std::string& yaml, const std::string& path);

// The estimator of a file of `rcme conform`, before it is conformed. Its command, if it has one, is the file's.
// Throws InputError as ReadConformFile.
EstimatorSpec LoadConformedEstimator(const std::string& path);

// A file with every option written out, defaults included: ParseEstimatorFile gives the same estimator back.
std::string EstimatorFileText(const EstimatorSpec& spec, const Provenance& provenance);

}  // namespace rcme
