#include "experiments/core/files/shared_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "experiments/core/text/pick_name.h"
#include "parameters/input_error.h"
#include "parameters/suggestion.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".yaml";

const char* FindFolderName(SharedFolder folder) {
  return PickName(folder, {"studies", "estimator_files", "populations", "plots"});
}

std::string FormatListCommand(SharedFolder folder) {
  return std::string("rcme list ") + FindFolderName(folder);
}

fs::path BesideProgram() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path() : (program.parent_path() / RCME_SHARE_FROM_PROGRAM).lexically_normal();
}

std::string& Share() {
  static std::string share = BesideProgram().string();
  return share;
}

bool IsFolder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

}  // namespace

std::string FindShare() { return IsFolder(Share()) ? Share() : std::string(); }

void UseShare(const std::string& folder) { Share() = folder; }

std::string FindSharedFolder(SharedFolder folder) {
  const std::string share = FindShare();
  const fs::path path = fs::path(share) / FindFolderName(folder);
  return !share.empty() && IsFolder(path) ? path.string() : std::string();
}

std::vector<std::string> NamesIn(SharedFolder folder) {
  const std::string path = FindSharedFolder(folder);
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
  if (std::ranges::count(names, bare) > 0)
    return (fs::path(FindSharedFolder(folder)) / (bare + kEnding)).string();
  const std::string suggestion = DidYouMean(fs::path(bare).filename().string(), names);
  if (names.empty() && !IsFolder(Share()))
    throw InputError(
        fmt::format("{}: no such {}; the folder of installed ones, {}, is missing: build or install "
                    "the program again",
                    name, kind.name, Share()));
  if (suggestion.empty()) return name;
  throw InputError(
      fmt::format("{}: no such {}{}; installed: {}", name, kind.name, suggestion, FormatListCommand(folder)));
}

}  // namespace rcme
