#include "experiments/draw_figures.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <filesystem>

extern char** environ;

namespace rcme {
namespace {

// The plots of the source tree this was built from, else the installed ones.
std::filesystem::path ScriptPath(const std::string& script) {
  const std::filesystem::path in_source = std::filesystem::path(RCME_SOURCE_PLOTS) / script;
  return std::filesystem::exists(in_source) ? in_source
                                            : std::filesystem::path(RCME_INSTALLED_PLOTS) / script;
}

bool RunsWell(const char* python, std::string script, std::string folder) {
  std::string name = python;
  std::array<char*, 4> arguments = {name.data(), script.data(), folder.data(), nullptr};
  posix_spawn_file_actions_t to_nowhere;  // what the script prints are the names of its figures
  posix_spawn_file_actions_init(&to_nowhere);
  posix_spawn_file_actions_addopen(&to_nowhere, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int error = posix_spawnp(&child, python, &to_nowhere, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&to_nowhere);
  if (error != 0) return false;
  int status = 0;
  return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

void DrawFigures(const std::string& script, const std::string& folder) {
  const std::string path = ScriptPath(script).string();
  // Debian's own Python first: another one may stand before it on PATH, without matplotlib.
  for (const char* python : {"/usr/bin/python3", "python3"}) {
    if (RunsWell(python, path, folder)) return;
  }
  fmt::print(stderr, "the figures were not drawn; with matplotlib and pandas installed: python3 {} {}\n",
             path, folder);
}

}  // namespace rcme
