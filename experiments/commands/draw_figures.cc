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
std::string ScriptPath(const std::string& kind) {
  const std::string script = kind + ".py";
  const std::filesystem::path in_source = std::filesystem::path(RCME_SOURCE_PLOTS) / script;
  const std::filesystem::path installed = std::filesystem::path(RCME_INSTALLED_PLOTS) / script;
  return (std::filesystem::exists(in_source) ? in_source : installed).string();
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
  // Debian's own Python first: another one may stand before it on PATH, without matplotlib.
  for (const char* python : {"/usr/bin/python3", "python3"}) {
    if (!RunsWell({python, "-c", kHasPackages}, ScriptOutput::kDropped)) continue;
    std::vector<std::string> command = {python, ScriptPath(kind)};
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
  const ScriptEnd end = RunPlotScript(kind, arguments, ScriptOutput::kDropped);
  if (end == ScriptEnd::kDone) return;
  const char* way = end == ScriptEnd::kNoPython ? "with matplotlib and pandas installed" : "see above; again";
  PrintMessage("the figures were not drawn; {}: rcme plot {} {}\n", way, kind, fmt::join(arguments, " "));
}

}  // namespace rcme
