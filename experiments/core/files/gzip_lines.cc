#include "experiments/core/files/gzip_lines.h"

#include <fmt/format.h>
#include <unistd.h>

#include "parameters/input_error.h"

namespace rcme {
namespace {

constexpr std::string_view kGzipMagic = "\x1F\x8B";

}  // namespace

GzipLines::GzipLines(const std::string& path, const FileKind& kind)
    : GzipLines(path, RegularFile(path, kind).Release()) {}

GzipLines::GzipLines(std::string name, int descriptor)
    : path_(std::move(name)), bytes_(std::make_unique<GzipBytes>(descriptor)) {}

GzipLines GzipLines::OfStandardInput() { return GzipLines("standard input", dup(STDIN_FILENO)); }

bool GzipLines::Next(std::string_view* line) {
  line_.clear();
  ++line_number_;
  int c = 0;
  while ((c = bytes_->Next()) >= 0 && c != '\n') {
    if (line_.size() == kMaxLineBytes)
      Fail(fmt::format("the line is too long; at most {} bytes are allowed", kMaxLineBytes));
    line_ += static_cast<char>(c);
    if (line_number_ == 1 && line_ == kGzipMagic)
      throw InputError(fmt::format("{}: is packed twice (gzip within gzip); unpack it once", path_));
  }
  if (c < 0) CheckEnd();
  num_bytes_ += line_.size() + 1;
  if (num_bytes_ > kMaxBytes)
    Fail(fmt::format("the text is too long; at most {} MiB, unpacked, are allowed", kMaxBytes >> 20));
  *line = line_;
  return c >= 0 || !line_.empty();
}

void GzipLines::Fail(const std::string& what) const {
  throw InputError(fmt::format("{}:{}: {}", path_, line_number_, what));
}

void GzipLines::CheckEnd() const {
  if (bytes_->damage().empty()) return;
  throw InputError(fmt::format("{}: damaged or truncated gzip file ({})", path_, bytes_->damage()));
}

}  // namespace rcme
