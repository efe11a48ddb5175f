// The options of the front end (features.h), the same for all commands that match images.
#pragma once

#include <CLI/CLI.hpp>

#include "experiments/data/features.h"

namespace rcme {

void AddFrontEndOptions(CLI::App* command, DetectorOptions* detector, MatcherOptions* matcher);

}  // namespace rcme
