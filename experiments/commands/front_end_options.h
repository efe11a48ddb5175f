// Options of the front end (features.h), shared by all commands that match images.
#pragma once

#include <CLI/CLI.hpp>

#include "experiments/real/images/features.h"

namespace rcme {

void AddFrontEndOptions(CLI::App* command, DetectorOptions* detector, MatcherOptions* matcher,
                        bool* has_scores);

}  // namespace rcme
