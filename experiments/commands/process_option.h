// The option --allow-process, for all commands that call estimators (study/command_permission.h).
#pragma once

#include <CLI/CLI.hpp>
#include <vector>

#include "experiments/study/estimator_spec.h"

namespace rcme {

void AddProcessOption(CLI::App* command, bool* is_allowed);

// Allows the commands that estimators from files name, and prints them on standard error.
void AllowAndSay(std::vector<EstimatorSpec>* estimators);

}  // namespace rcme
