#pragma once

#include <string>
#include <vector>

namespace rcme {

enum class ScriptEnd {
  kDone,
  kNoPython,  // no python3 was found that has matplotlib and pandas
  kFailed,    // the script gave the reason on standard error
};

// Whether to show the standard output of a script: the names of its files, or its help.
enum class ScriptOutput { kShown, kDropped };

// Runs the script plots/KIND.py (core/files/shared_files.h) with these arguments, by a Python that has
// matplotlib and pandas. Throws InputError if the scripts are missing.
ScriptEnd RunPlotScript(const std::string& kind, const std::vector<std::string>& arguments,
                        ScriptOutput output);

// RunPlotScript without output, for a command whose result is the figure. Throws InputError that begins with
// the command's name if Python packages are missing or the script fails.
void DrawOrThrow(const std::string& command, const std::string& kind,
                 const std::vector<std::string>& arguments);

// RunPlotScript without output, for a command that has other results too, already written. A failure (such as
// no Python with matplotlib) only prints a message on standard error, which says how to draw the figures
// later.
void DrawFigures(const std::string& kind, const std::vector<std::string>& arguments);

// Throws InputError that begins with the command's name and says which Python packages are needed.
[[noreturn]] void ThrowNoPython(const std::string& command);

}  // namespace rcme
