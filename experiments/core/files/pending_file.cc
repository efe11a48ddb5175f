#include "experiments/core/files/pending_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>
#include <string_view>

#include "experiments/core/files/owner_lock.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSuffix = ".part";
constexpr int kMaxAttempts = 100;

// The network name of this machine; characters that could confuse a file name become '_'.
std::string HostName() {
  std::array<char, 65> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return "unknown";
  std::string host(name.data());
  std::ranges::replace_if(
      host, [](unsigned char c) { return std::isalnum(c) == 0 && c != '.' && c != '_'; }, '_');
  return host;
}

// The part of a file name that marks temporary files of this machine.
const std::string& MarkOfHost() {
  static const std::string mark = fmt::format(".rcme-{}-", HostName());
  return mark;
}

fs::path FindFolder(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? "." : folder;
}

// The name is cut if it would be longer than a file system allows.
std::string MakePartPath(const std::string& path, int number) {
  const std::string mark = fmt::format("{}{}-{}{}", MarkOfHost(), getpid(), number, kSuffix);
  const std::string name = fs::path(path).filename().string().substr(0, NAME_MAX - mark.size());
  return (fs::path(path).parent_path() / (name + mark)).string();
}

// Returns whether `name` is NAME.rcme-HOST-PROCESS-NUMBER.part with this machine as HOST.
bool IsPartOfThisHost(std::string_view name) {
  const size_t mark = name.rfind(MarkOfHost());
  if (mark == std::string_view::npos || !name.ends_with(kSuffix)) return false;
  name.remove_prefix(mark + MarkOfHost().size());
  name.remove_suffix(kSuffix.size());
  return !name.empty() && name.find_first_not_of("0123456789-") == std::string_view::npos;
}

void RemoveAbandonedParts(const fs::path& folder) {
  std::error_code error;  // files that cannot be looked at or removed stay
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    if (!IsPartOfThisHost(entry->path().filename().string())) continue;
    RemoveIfAbandoned(entry->path().string(), [](const std::string& path) { std::remove(path.c_str()); });
  }
}

// Runs once per process and folder: a folder may get a file for each of a million trials.
void RemoveAbandonedPartsOnce(const fs::path& folder) {
  static std::mutex mutex;
  static std::set<fs::path> seen;
  std::error_code error;
  const fs::path absolute = fs::absolute(folder, error);
  const std::lock_guard lock(mutex);
  if (!error && seen.insert(absolute).second) RemoveAbandonedParts(absolute);
}

// Syncs a folder, so that a renamed file survives a power failure. Errors are ignored, because the file
// itself is written.
void SyncFolder(const fs::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

// Returns false and sets errno if the bytes are not on disk. File systems without this request count as
// synced.
bool SyncFile(int descriptor) { return fsync(descriptor) == 0 || errno == EINVAL || errno == ENOTSUP; }

}  // namespace

void ThrowCannotWrite(const std::string& path, int error) {
  throw InputError(fmt::format("{}: cannot be written: {}", path, std::strerror(error)));
}

PendingFile::PendingFile(const std::string& path) : path_(path) {
  RemoveAbandonedPartsOnce(FindFolder(path));
  for (int number = 0; number < kMaxAttempts; ++number) {
    part_ = MakePartPath(path, number);
    descriptor_ = open(part_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno == EEXIST) continue;
    if (descriptor_ < 0) ThrowCannotWrite(path, errno);
    if (LockOwn(part_, descriptor_)) return;
    close(descriptor_);
  }
  ThrowCannotWrite(path, EEXIST);
}

PendingFile::~PendingFile() {
  if (!part_.empty()) std::remove(part_.c_str());
  close(descriptor_);
}

void PendingFile::PutInPlace() {
  if (!SyncFile(descriptor_) || std::rename(part_.c_str(), path_.c_str()) != 0)
    ThrowCannotWrite(path_, errno);
  part_.clear();
  SyncFolder(FindFolder(path_));
}

}  // namespace rcme
