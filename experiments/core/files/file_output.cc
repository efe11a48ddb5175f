#include "experiments/core/files/file_output.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <utility>

#include "parameters/input_error.h"

namespace rcme {
namespace {

// Returns whether `path` is a device, a pipe or a folder: nothing can be renamed over it.
bool IsSpecial(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored);
}

void CheckIsNoResultStore(const std::string& path) {
  constexpr std::string_view kMagic = "SQLite format 3";
  char head[kMagic.size()] = {};
  if (!std::ifstream(path, std::ios::binary).read(head, sizeof(head))) return;
  if (std::string_view(head, sizeof(head)) == kMagic) {
    throw InputError(
        fmt::format("{}: holds the results of a run and is not replaced; give another file", path));
  }
}

}  // namespace

FileInPieces::FileInPieces(const std::string& path) : path_(path) {
  if (path.empty()) {
    file_ = stdout;
  } else if (IsSpecial(path)) {
    file_ = std::fopen(path.c_str(), "wb");
  } else {
    CheckIsNoResultStore(path);
    pending_.emplace(path);
    file_ = fdopen(dup(pending_->descriptor()), "wb");
  }
  if (!file_) ThrowCannotWrite(path, errno);
}

FileInPieces::~FileInPieces() {
  if (file_ && file_ != stdout) std::fclose(file_);
}

void FileInPieces::Write(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size())
    ThrowCannotWrite(path_.empty() ? "standard output" : path_, errno);
}

void FileInPieces::Finish() {
  if (std::fflush(file_) != 0) ThrowCannotWrite(path_.empty() ? "standard output" : path_, errno);
  if (file_ == stdout) return;
  if (std::fclose(std::exchange(file_, nullptr)) != 0) ThrowCannotWrite(path_, errno);
  if (pending_) pending_->PutInPlace();
}

void WriteFileWhole(const std::string& path, const std::string& text) {
  if (path.empty()) ThrowCannotWrite(path, ENOENT);
  FileInPieces file(path);
  file.Write(text);
  file.Finish();
}

void CheckCanBeWritten(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) ThrowCannotWrite(path, EISDIR);
  if (error && error != std::errc::no_such_file_or_directory) ThrowCannotWrite(path, error.value());
  if (IsSpecial(path)) return;  // opening a pipe may wait for a reader
  CheckIsNoResultStore(path);
  const FileInPieces opened(path);
}

void CheckIsNoInput(const std::string& path, const std::vector<std::string>& inputs) {
  std::error_code ignored;  // a file may not exist
  for (const std::string& input : inputs) {
    if (std::filesystem::equivalent(path, input, ignored)) {
      throw InputError(fmt::format("--out: '{}' is the input itself; give another place", path));
    }
  }
}

void PrintOrWrite(const std::string& path, const std::string& text) {
  FileInPieces file(path);
  file.Write(text);
  file.Finish();
}

void MakeResultFolder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (!std::filesystem::is_directory(path)) {
    throw InputError(fmt::format("{}: cannot be made a folder: {}", path, error.message()));
  }
  if (access(path.c_str(), W_OK) != 0) {
    throw InputError(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
  }
}

}  // namespace rcme
