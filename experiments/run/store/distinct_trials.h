// Whether result files hold the same trials, which several files taken together must not.
#pragma once

#include <span>
#include <string>

namespace rcme {

// Throws InputError that names two of the result files if they are of the same study and hold a trial both.
void RequireDistinctTrials(std::span<const std::string> paths);

}  // namespace rcme
