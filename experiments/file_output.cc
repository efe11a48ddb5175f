#include "experiments/file_output.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

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

}  // namespace

void WriteFileWhole(const std::string& path, const std::string& text) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const bool is_special = fs::exists(path, ignored) && !fs::is_regular_file(path, ignored);
  const std::string target = is_special ? path : fmt::format("{}.{}.part", path, getpid());
  if (WriteAll(target, text) && (is_special || std::rename(target.c_str(), path.c_str()) == 0)) return;
  const std::string reason = std::strerror(errno);
  if (!is_special) fs::remove(target, ignored);
  throw InputError(fmt::format("{}: cannot be written: {}", path, reason));
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
