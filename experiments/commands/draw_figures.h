#pragma once

#include <string>
#include <vector>

namespace rcme {

enum class ScriptEnd {
  kDone,
  kNoPython,  // no python3 on this machine has matplotlib and pandas
  kFailed,    // the script said why on standard error
};

// Runs a script of plots/ with these arguments; what it prints (the names of what it wrote) is dropped.
ScriptEnd RunPlotScript(const std::string& script, const std::vector<std::string>& arguments);

// The same, where the command's result is what the script draws. Throws InputError that begins with the
// command's name and says what is missing.
void DrawOrThrow(const std::string& command, const std::string& script,
                 const std::vector<std::string>& arguments);

// The same where the figures are not all there is. A failure (no Python with matplotlib) is a message on
// standard error that says how to draw the figures later: the results themselves are already written.
void DrawFigures(const std::string& script, const std::vector<std::string>& arguments);

}  // namespace rcme
