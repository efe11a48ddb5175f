#include "experiments/base/file_output.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "parameters/input_error.h"

namespace rcme {
namespace {

bool WriteAll(const std::string& path, const std::string& text) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file) return false;
  const bool is_written =
      std::fwrite(text.data(), 1, text.size(), file) == text.size() && std::fflush(file) == 0;
  const int error = errno;
  const bool is_closed = std::fclose(file) == 0;
  if (!is_written) errno = error;
  return is_written && is_closed;
}

// A device, a pipe, a folder: nothing can be renamed over it.
bool IsSpecial(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored);
}

std::string PartOf(const std::string& path) { return fmt::format("{}.{}.part", path, getpid()); }

[[noreturn]] void ThrowCannotWrite(const std::string& path, int error) {
  throw InputError(fmt::format("{}: cannot be written: {}", path, std::strerror(error)));
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

void WriteFileWhole(const std::string& path, const std::string& text) {
  const bool is_special = IsSpecial(path);
  if (!is_special) CheckIsNoResultStore(path);
  const std::string target = is_special ? path : PartOf(path);
  if (WriteAll(target, text) && (is_special || std::rename(target.c_str(), path.c_str()) == 0)) return;
  const int error = errno;
  std::error_code ignored;
  if (!is_special) std::filesystem::remove(target, ignored);
  ThrowCannotWrite(path, error);
}

void CheckCanBeWritten(const std::string& path) {
  if (std::filesystem::is_directory(path)) ThrowCannotWrite(path, EISDIR);
  if (IsSpecial(path)) return;  // to open a pipe may take a reader
  CheckIsNoResultStore(path);
  if (!WriteAll(PartOf(path), "")) ThrowCannotWrite(path, errno);
  std::filesystem::remove(PartOf(path));
}

void CheckIsNoInput(const std::string& path, const std::vector<std::string>& inputs) {
  std::error_code ignored;  // of a file that is not there
  for (const std::string& input : inputs) {
    if (std::filesystem::equivalent(path, input, ignored)) {
      throw InputError(fmt::format("--out: '{}' is the input itself; give another file", path));
    }
  }
}

void PrintOrWrite(const std::string& path, const std::string& text) {
  if (path.empty()) {
    fmt::print("{}", text);
  } else {
    WriteFileWhole(path, text);
  }
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
