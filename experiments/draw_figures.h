#pragma once

#include <string>

namespace rcme {

// Runs a script of plots/ on a folder of results. A failure (no Python with matplotlib) is a message on
// standard error that says how to draw the figures later: the results themselves are already written.
void DrawFigures(const std::string& script, const std::string& folder);

}  // namespace rcme
