#include "experiments/core/files/regular_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "parameters/input_error.h"

namespace rcme {
namespace {

std::string DescribeKind(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

}  // namespace

RegularFile::RegularFile(const std::string& path, const FileKind& kind) : path_(path) {
  if (path.empty())
    throw InputError(fmt::format("'' is not allowed; give the path of {}", kind.article_name));
  struct stat status {};
  // Non-blocking, because opening a pipe without a writer would wait for ever. A socket cannot be opened at
  // all.
  descriptor_ = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  const int error = errno;
  if ((descriptor_ >= 0 ? fstat(descriptor_, &status) : stat(path.c_str(), &status)) != 0)
    throw InputError(fmt::format("{}: no such {} ({})", path, kind.name, std::strerror(errno)));
  if (!S_ISREG(status.st_mode)) {
    if (descriptor_ >= 0) close(descriptor_);
    throw InputError(fmt::format("{}: is {}, not {}", path, DescribeKind(status.st_mode), kind.article_name));
  }
  if (descriptor_ < 0) throw InputError(fmt::format("{}: cannot be read: {}", path, std::strerror(error)));
}

RegularFile::~RegularFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

std::string RegularFile::Read(size_t max_bytes) {
  std::string bytes;
  std::array<char, 1 << 16> buffer{};
  while (bytes.size() < max_bytes) {
    const ssize_t num_read =
        read(descriptor_, buffer.data(), std::min(buffer.size(), max_bytes - bytes.size()));
    if (num_read == 0) break;
    if (num_read < 0 && errno == EINTR) continue;
    if (num_read < 0) throw InputError(fmt::format("{}: cannot be read: {}", path_, std::strerror(errno)));
    bytes.append(buffer.data(), static_cast<size_t>(num_read));
  }
  return bytes;
}

int RegularFile::Release() { return std::exchange(descriptor_, -1); }

}  // namespace rcme
