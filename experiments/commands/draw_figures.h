#pragma once

#include <string>
#include <vector>

namespace rcme {

enum class ScriptEnd {
  kDone,
  kNoPython,  // no python3 on this machine has matplotlib and pandas
  kFailed,    // the script said why on standard error
};

// What a script prints on standard output: the names of what it wrote, or its help.
enum class ScriptOutput { kShown, kDropped };

// Runs the script plots/KIND.py (core/files/shared_files.h) with these arguments, with a Python that has what it
// needs. Throws InputError where the scripts are not there.
ScriptEnd RunPlotScript(const std::string& kind, const std::vector<std::string>& arguments,
                        ScriptOutput output);

// The same, its output dropped, where the command's result is what the script draws. Throws InputError that
// begins with the command's name and says what is missing.
void DrawOrThrow(const std::string& command, const std::string& kind,
                 const std::vector<std::string>& arguments);

// The same where the figures are not all there is. A failure (no Python with matplotlib) is a message on
// standard error that says how to draw the figures later: the results themselves are already written.
void DrawFigures(const std::string& kind, const std::vector<std::string>& arguments);

// Throws InputError that begins with the command's name and says which packages of Python are missing.
[[noreturn]] void ThrowNoPython(const std::string& command);

}  // namespace rcme
