#include "experiments/base/shared_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "parameters/input_error.h"
#include "parameters/suggestion.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".yaml";

const char* NameOf(SharedFolder folder) {
  return folder == SharedFolder::kStudies ? "studies" : "estimators";
}

std::string ListOf(SharedFolder folder) {
  return folder == SharedFolder::kStudies ? "rcme list studies" : "rcme list estimator_files";
}

fs::path BesideProgram() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path() : program.parent_path().parent_path() / "share/rcme";
}

}  // namespace

std::string PathOf(SharedFolder folder) {
  for (const fs::path& shared :
       {BesideProgram(), fs::path(RCME_SOURCE_SHARED), fs::path(RCME_INSTALLED_SHARED)}) {
    std::error_code ignored;
    const fs::path path = shared / NameOf(folder);
    if (!shared.empty() && fs::is_directory(path, ignored)) return path.string();
  }
  return {};
}

std::vector<std::string> NamesIn(SharedFolder folder) {
  const std::string path = PathOf(folder);
  std::vector<std::string> names;
  if (path.empty()) return names;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path)) {
    if (entry.path().extension() != kEnding) continue;
    const std::string name = entry.path().lexically_relative(path).string();
    names.push_back(name.substr(0, name.size() - std::string(kEnding).size()));
  }
  std::ranges::sort(names);
  return names;
}

std::string FindFile(const std::string& name, SharedFolder folder, const FileKind& kind) {
  std::error_code ignored;
  if (name.empty() || fs::exists(name, ignored) || fs::path(name).is_absolute()) return name;
  const std::vector<std::string> names = NamesIn(folder);
  const std::string bare =
      name.ends_with(kEnding) ? name.substr(0, name.size() - std::string(kEnding).size()) : name;
  if (std::ranges::count(names, bare) > 0) return (fs::path(PathOf(folder)) / (bare + kEnding)).string();
  const std::string suggestion = DidYouMean(fs::path(bare).filename().string(), names);
  if (suggestion.empty()) return name;
  throw InputError(fmt::format("{}: no such {}{}; those that come with the program: {}", name, kind.name,
                               suggestion, ListOf(folder)));
}

}  // namespace rcme
