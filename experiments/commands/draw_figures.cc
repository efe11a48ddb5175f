#include "experiments/commands/draw_figures.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "experiments/base/message.h"
#include "parameters/input_error.h"

extern char** environ;

namespace rcme {
namespace {

// Whether a Python has what the scripts need, without the second that loading it would take.
constexpr const char* kHasPackages =
    "import importlib.util as u, sys; sys.exit(not all(map(u.find_spec, ('matplotlib', 'pandas'))))";

// The plots of the source tree this was built from, else the installed ones.
std::string ScriptPath(const std::string& script) {
  const std::filesystem::path in_source = std::filesystem::path(RCME_SOURCE_PLOTS) / script;
  const std::filesystem::path installed = std::filesystem::path(RCME_INSTALLED_PLOTS) / script;
  return (std::filesystem::exists(in_source) ? in_source : installed).string();
}

// Whether a program of PATH ends with exit code 0. Its standard output goes nowhere.
bool RunsWell(std::vector<std::string> command) {
  std::vector<char*> words;
  for (std::string& word : command) words.push_back(word.data());
  words.push_back(nullptr);
  posix_spawn_file_actions_t to_nowhere;
  posix_spawn_file_actions_init(&to_nowhere);
  posix_spawn_file_actions_addopen(&to_nowhere, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int error = posix_spawnp(&child, words[0], &to_nowhere, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&to_nowhere);
  if (error != 0) return false;
  int status = 0;
  return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

ScriptEnd RunPlotScript(const std::string& script, const std::vector<std::string>& arguments) {
  // Debian's own Python first: another one may stand before it on PATH, without matplotlib.
  for (const char* python : {"/usr/bin/python3", "python3"}) {
    if (!RunsWell({python, "-c", kHasPackages})) continue;
    std::vector<std::string> command = {python, ScriptPath(script)};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return RunsWell(std::move(command)) ? ScriptEnd::kDone : ScriptEnd::kFailed;
  }
  return ScriptEnd::kNoPython;
}

void DrawOrThrow(const std::string& command, const std::string& script,
                 const std::vector<std::string>& arguments) {
  const ScriptEnd end = RunPlotScript(script, arguments);
  if (end == ScriptEnd::kNoPython) {
    throw InputError(fmt::format(
        "{}: needs python3 with matplotlib and pandas; on Debian: apt-get install python3-matplotlib "
        "python3-pandas",
        command));
  }
  if (end == ScriptEnd::kFailed)
    throw InputError(fmt::format("{}: nothing was drawn, for the reason above", command));
}

void DrawFigures(const std::string& script, const std::vector<std::string>& arguments) {
  const ScriptEnd end = RunPlotScript(script, arguments);
  if (end == ScriptEnd::kDone) return;
  const char* way = end == ScriptEnd::kNoPython ? "with matplotlib and pandas installed" : "see above; again";
  PrintMessage("the figures were not drawn; {}: python3 {} {}\n", way, ScriptPath(script),
               fmt::join(arguments, " "));
}

}  // namespace rcme
