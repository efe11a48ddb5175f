// The estimator `conform`: calibrates the answers of another estimator by a rule that was learned on problems
// with known truth (conform_rule.h, `rcme conform`).
#pragma once

#include <memory>
#include <string>

#include "estimator/conform/conform_file.h"
#include "estimator/estimator_model.h"

namespace rcme {

inline constexpr const char* kConformEstimator = "conform";

// Options: file; digest (of its content; a file with another one is refused); accept_rule (apply: refuse
// answers that the rule does not accept; ignore: only state the probability). The file names the estimator
// and its options.
std::unique_ptr<EstimatorModel> ConformModel();

// The values of the options `file` and `digest` for a file. Throws InputError as ReadConformFile.
Settings ConformOptions(const std::string& path);

}  // namespace rcme
