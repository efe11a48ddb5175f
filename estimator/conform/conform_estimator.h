// The estimator `conform`: another estimator, whose answers are made to keep their word by what problems with
// truth have taught (conform_rule.h, `rcme conform`).
#pragma once

#include <memory>
#include <string>

#include "estimator/conform/conform_file.h"
#include "estimator/estimator_model.h"

namespace rcme {

inline constexpr const char* kConformEstimator = "conform";

// Options: file, digest (of its content: another is refused), accept_rule (apply: refuse what the rule does
// not accept; ignore: state the probability alone). The file names the estimator with its options.
std::unique_ptr<EstimatorModel> ConformModel();

// What the options `file` and `digest` take. Throws InputError as ReadConformFile.
Settings ConformOptions(const std::string& path);

}  // namespace rcme
