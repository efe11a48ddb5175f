#include "experiments/core/files/gzip_bytes.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace rcme {
namespace {

constexpr size_t kBufferBytes = size_t{64} << 10;
constexpr int kGzipWindow = 15 + 16;  // the largest window, with gzip's header

}  // namespace

GzipBytes::GzipBytes(int descriptor) : descriptor_(descriptor), in_(kBufferBytes), out_(kBufferBytes) {
  stream_.next_in = reinterpret_cast<Bytef*>(in_.data());
}

GzipBytes::~GzipBytes() {
  if (kind_ == Kind::kGzip) inflateEnd(&stream_);
  close(descriptor_);
}

// Appends to what is left of the input.
bool GzipBytes::ReadInput() {
  std::memmove(in_.data(), stream_.next_in, stream_.avail_in);
  stream_.next_in = reinterpret_cast<Bytef*>(in_.data());
  ssize_t count = 0;
  do {
    count = read(descriptor_, in_.data() + stream_.avail_in, in_.size() - stream_.avail_in);
  } while (count < 0 && errno == EINTR);
  if (count < 0) damage_ = std::strerror(errno);
  if (count <= 0) return false;
  stream_.avail_in += static_cast<uInt>(count);
  return true;
}

// Finds out whether it is a gzip file, by its first two bytes.
bool GzipBytes::Begin() {
  while (stream_.avail_in < 2 && ReadInput()) {
  }
  const bool is_gzip = stream_.avail_in >= 2 && stream_.next_in[0] == 0x1F && stream_.next_in[1] == 0x8B;
  kind_ = is_gzip ? Kind::kGzip : Kind::kPlain;
  if (is_gzip && inflateInit2(&stream_, kGzipWindow) != Z_OK) {
    kind_ = Kind::kPlain;
    damage_ = "cannot be unpacked";
  }
  return damage_.empty();
}

bool GzipBytes::FillPlain() {
  if (stream_.avail_in == 0 && !ReadInput()) return false;
  std::copy_n(reinterpret_cast<const char*>(stream_.next_in), stream_.avail_in, out_.begin());
  end_ = stream_.avail_in;
  stream_.avail_in = 0;
  return true;
}

// Unpacks until there are bytes.
bool GzipBytes::Unpack() {
  while (end_ == 0) {
    if (stream_.avail_in == 0 && !ReadInput()) {
      if (is_within_member_ && damage_.empty()) damage_ = "unexpected end of file";
      return false;
    }
    if (!is_within_member_) inflateReset(&stream_);
    is_within_member_ = true;
    stream_.next_out = reinterpret_cast<Bytef*>(out_.data());
    stream_.avail_out = static_cast<uInt>(out_.size());
    const int status = inflate(&stream_, Z_NO_FLUSH);
    end_ = out_.size() - stream_.avail_out;
    if (status == Z_STREAM_END) is_within_member_ = false;
    if (status == Z_OK || status == Z_STREAM_END || status == Z_BUF_ERROR) continue;
    damage_ = stream_.msg != nullptr ? stream_.msg : "cannot be unpacked";
    end_ = 0;
    return false;
  }
  return true;
}

bool GzipBytes::Fill() {
  at_ = end_ = 0;
  if (!damage_.empty() || (kind_ == Kind::kUnknown && !Begin())) return false;
  return kind_ == Kind::kPlain ? FillPlain() : Unpack();
}

}  // namespace rcme
