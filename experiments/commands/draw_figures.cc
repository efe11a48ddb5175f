#include "experiments/commands/draw_figures.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "experiments/core/files/shared_files.h"
#include "experiments/core/text/message.h"
#include "experiments/core/text/shell_word.h"
#include "parameters/input_error.h"

extern char** environ;

namespace rcme {
namespace {

// Whether a Python has what the scripts need, without the second that loading it would take.
// `python -c` looks for modules in the working directory first, where files of others may lie: not here.
constexpr const char* kHasPackages =
    "import sys; sys.path = [p for p in sys.path if p]; import importlib.util as u; "
    "sys.exit(not all(map(u.find_spec, ('matplotlib', 'pandas'))))";

std::string FindPlots() {
  const std::string folder = FindSharedFolder(SharedFolder::kPlots);
  if (folder.empty())
    throw InputError(
        "the scripts that draw figures are missing: they belong in share/rcme/plots beside the program's "
        "folder bin; "
        "move the whole installation, or install it again with cmake --install");
  return folder;
}

// Whether a program of PATH ends with exit code 0.
bool RunsWell(std::vector<std::string> command, ScriptOutput output) {
  std::vector<char*> words;
  for (std::string& word : command) words.push_back(word.data());
  words.push_back(nullptr);
  posix_spawn_file_actions_t streams;
  posix_spawn_file_actions_init(&streams);
  if (output == ScriptOutput::kDropped)
    posix_spawn_file_actions_addopen(&streams, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int error = posix_spawnp(&child, words[0], &streams, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&streams);
  if (error != 0) return false;
  int status = 0;
  return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

ScriptEnd RunPlotScript(const std::string& kind, const std::vector<std::string>& arguments,
                        ScriptOutput output) {
  const std::string run_script = (std::filesystem::path(FindPlots()) / "common" / "run_script.py").string();
  // Debian's own Python first: another one may stand before it on PATH, without matplotlib.
  for (const char* python : {"/usr/bin/python3", "python3"}) {
    if (!RunsWell({python, "-c", kHasPackages}, ScriptOutput::kDropped)) continue;
    std::vector<std::string> command = {python, run_script, kind};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return RunsWell(std::move(command), output) ? ScriptEnd::kDone : ScriptEnd::kFailed;
  }
  return ScriptEnd::kNoPython;
}

void ThrowNoPython(const std::string& command) {
  throw InputError(fmt::format(
      "{}: needs python3 with matplotlib and pandas; on Debian: apt-get install python3-matplotlib "
      "python3-pandas",
      command));
}

void DrawOrThrow(const std::string& command, const std::string& kind,
                 const std::vector<std::string>& arguments) {
  const ScriptEnd end = RunPlotScript(kind, arguments, ScriptOutput::kDropped);
  if (end == ScriptEnd::kNoPython) ThrowNoPython(command);
  if (end == ScriptEnd::kFailed)
    throw InputError(fmt::format("{}: nothing was drawn, for the reason above", command));
}

void DrawFigures(const std::string& kind, const std::vector<std::string>& arguments) {
  try {
    const ScriptEnd end = RunPlotScript(kind, arguments, ScriptOutput::kDropped);
    if (end == ScriptEnd::kDone) return;
    const char* way =
        end == ScriptEnd::kNoPython ? "with matplotlib and pandas installed" : "see above; again";
    std::string command = "rcme plot " + kind;
    for (const std::string& argument : arguments) command += " " + QuoteForShell(argument);
    PrintMessage("the figures were not drawn; {}: {}\n", way, command);
  } catch (const InputError& error) {
    PrintMessage("the figures were not drawn: {}\n", error.what());
  }
}

}  // namespace rcme
