#include "experiments/real/sequences/npz_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include <algorithm>

#include "experiments/core/files/regular_file.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

constexpr std::string_view kZipDamaged = "is cut off, damaged or no file of numpy.savez";
constexpr std::string_view kNpyEnding = ".npy";
constexpr size_t kEndRecordBytes = 22, kDirectoryEntryBytes = 46, kLocalHeaderBytes = 30;
constexpr std::uint32_t kEndSignature = 0x06054b50, kDirectorySignature = 0x02014b50,
                        kLocalSignature = 0x04034b50;
constexpr size_t kStored = 0, kDeflated = 8;
// Flags: bit 0, the member is encrypted; 1 and 2, quality of compression; 3, sizes also follow the member;
// 11, names are UTF-8.
constexpr size_t kKnownFlags = 0x080e;
constexpr size_t kMostDeflated = 1032;  // greatest compression ratio of deflate

// Little-endian; the caller makes sure that the bytes exist.
std::uint32_t ZipNumber(std::string_view bytes, size_t at, size_t num_bytes) {
  std::uint32_t number = 0;
  for (size_t i = num_bytes; i-- > 0;) number = number << 8 | static_cast<unsigned char>(bytes[at + i]);
  return number;
}

// Decompresses all of `packed` to exactly `num_unpacked` bytes; returns false if it does not contain that.
bool Inflate(std::string_view packed, size_t num_unpacked, std::string* unpacked) {
  unpacked->assign(num_unpacked, '\0');
  z_stream stream = {};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
  std::string input(packed);
  char nothing = 0;
  stream.next_in = reinterpret_cast<Bytef*>(input.data());
  stream.avail_in = static_cast<uInt>(input.size());
  stream.next_out = reinterpret_cast<Bytef*>(num_unpacked > 0 ? unpacked->data() : &nothing);
  stream.avail_out = static_cast<uInt>(num_unpacked);
  const int end = inflate(&stream, Z_FINISH);
  const bool is_whole = end == Z_STREAM_END && stream.avail_in == 0 && stream.avail_out == 0;
  inflateEnd(&stream);
  return is_whole;
}

}  // namespace

std::string FormatShape(const std::vector<size_t>& shape) {
  return fmt::format("[{}]", fmt::join(shape, ", "));
}

void NpzFile::Fail(const std::string& what) const { throw InputError(fmt::format("{}: {}", path_, what)); }

std::string NpzFile::Place(const std::string& name) const {
  return fmt::format("{}: array {}", path_, Quoted(name));
}

NpzFile::NpzFile(const std::string& path) : path_(path) {
  RegularFile file(path, {"npz file", "an npz file"});
  while (bytes_.size() <= kMaxBytes) {
    const std::string more = file.Read(size_t{1} << 20);
    if (more.empty()) break;
    bytes_ += more;
  }
  if (bytes_.size() > kMaxBytes)
    Fail(fmt::format("is larger than {} MiB, which is what is allowed", kMaxBytes >> 20));
  ReadDirectory();
}

// The record at the end states where the directory is: directly before it.
void NpzFile::ReadDirectory() {
  size_t end = bytes_.size() < kEndRecordBytes ? 0 : bytes_.size() - kEndRecordBytes;
  const size_t least_end = end - std::min<size_t>(end, 0xffff);  // a comment may follow it
  const auto is_end = [&](size_t at) {
    return at + kEndRecordBytes <= bytes_.size() && ZipNumber(bytes_, at, 4) == kEndSignature &&
           at + kEndRecordBytes + ZipNumber(bytes_, at + 20, 2) == bytes_.size();
  };
  while (end > least_end && !is_end(end)) --end;
  if (!is_end(end)) Fail(std::string(kZipDamaged));
  const size_t num_members = ZipNumber(bytes_, end + 10, 2);
  const size_t num_bytes = ZipNumber(bytes_, end + 12, 4);
  directory_ = ZipNumber(bytes_, end + 16, 4);
  directory_end_ = end;
  if (num_members == 0xffff || num_bytes == 0xffffffff || directory_ == 0xffffffff)
    Fail("is a zip64 archive; save fewer or smaller arrays");
  if (num_members > kMaxArrays) Fail(fmt::format("holds {} arrays; {} are allowed", num_members, kMaxArrays));
  if (ZipNumber(bytes_, end + 4, 4) != 0 || ZipNumber(bytes_, end + 8, 2) != num_members ||
      directory_ + num_bytes != end)
    Fail(std::string(kZipDamaged));
  size_t at = directory_;
  for (size_t i = 0; i < num_members; ++i) at = AddMember(at);
  if (at != end) Fail(std::string(kZipDamaged));
  // A damaged name would hide an array that may be missing, so both copies of a name are compared.
  for (const auto& [name, member] : members_) PackedBytes(name, member);
}

size_t NpzFile::AddMember(size_t at) {
  if (at + kDirectoryEntryBytes > directory_end_ || ZipNumber(bytes_, at, 4) != kDirectorySignature)
    Fail(std::string(kZipDamaged));
  const auto number = [&](size_t offset, size_t num_bytes) {
    return ZipNumber(bytes_, at + offset, num_bytes);
  };
  const size_t name_bytes = number(28, 2);
  const size_t next = at + kDirectoryEntryBytes + name_bytes + number(30, 2) + number(32, 2);
  if (next > directory_end_) Fail(std::string(kZipDamaged));
  std::string name = bytes_.substr(at + kDirectoryEntryBytes, name_bytes);
  if (!name.ends_with(kNpyEnding))
    Fail(fmt::format("member {} is no array; NAME.npy is allowed", Quoted(name)));
  name.resize(name.size() - kNpyEnding.size());
  const Member member = {number(10, 2), number(20, 4), number(24, 4), number(42, 4), number(16, 4)};
  if ((number(8, 2) & ~kKnownFlags) != 0)
    throw InputError(Place(name) + ": is encrypted or packed in an unknown way; numpy.savez does neither");
  if (member.method != kStored && member.method != kDeflated)
    throw InputError(fmt::format("{}: is packed by method {}; 0 (stored) and 8 (deflate) are allowed",
                                 Place(name), member.method));
  if (member.num_packed == 0xffffffff || member.num_unpacked == 0xffffffff || member.offset == 0xffffffff)
    throw InputError(Place(name) + ": is a zip64 member; save a smaller array");
  if (!members_.emplace(name, member).second) throw InputError(Place(name) + ": stands twice in the file");
  return next;
}

std::string_view NpzFile::PackedBytes(const std::string& name, const Member& member) const {
  const std::string_view bytes = bytes_;
  // All summands are below 2^33, so no sum overflows.
  if (member.offset + kLocalHeaderBytes > directory_ || ZipNumber(bytes, member.offset, 4) != kLocalSignature)
    throw InputError(Place(name) + ": " + std::string(kZipDamaged));
  const size_t name_bytes = ZipNumber(bytes, member.offset + 26, 2);
  const size_t begin =
      member.offset + kLocalHeaderBytes + name_bytes + ZipNumber(bytes, member.offset + 28, 2);
  if (begin + member.num_packed > directory_ ||
      bytes.substr(member.offset + kLocalHeaderBytes, name_bytes) != name + std::string(kNpyEnding))
    throw InputError(Place(name) + ": " + std::string(kZipDamaged));
  return bytes.substr(begin, member.num_packed);
}

NpzArray NpzFile::Read(const std::string& name) const {
  const auto found = members_.find(name);
  if (found == members_.end()) {
    std::vector<std::string> known;
    for (const auto& [other, member] : members_) known.push_back(Quoted(other));
    if (known.size() > 20) known.resize(20);
    throw InputError(fmt::format("{}: is missing; the file has {}", Place(name),
                                 known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", "))));
  }
  const Member& member = found->second;
  const std::string_view packed = PackedBytes(name, member);
  if (member.num_unpacked > kMaxArrayBytes)
    throw InputError(fmt::format("{}: unpacks to {} bytes; {} MiB are allowed", Place(name),
                                 member.num_unpacked, kMaxArrayBytes >> 20));
  const bool is_stored = member.method == kStored;
  if (is_stored ? member.num_unpacked != packed.size() : member.num_unpacked > kMostDeflated * packed.size())
    throw InputError(
        fmt::format("{}: says that it unpacks from {} to {} bytes, which it cannot: the file is damaged",
                    Place(name), packed.size(), member.num_unpacked));
  std::string unpacked;
  if (is_stored) {
    unpacked = packed;
  } else if (!Inflate(packed, member.num_unpacked, &unpacked)) {
    throw InputError(Place(name) + ": cannot be unpacked: the file is damaged");
  }
  if (crc32(0, reinterpret_cast<const Bytef*>(unpacked.data()), static_cast<uInt>(unpacked.size())) !=
      member.crc)
    throw InputError(Place(name) + ": its bytes are not those of its checksum (CRC-32): the file is damaged");
  return ParseNpy(unpacked, Place(name));
}

}  // namespace rcme
