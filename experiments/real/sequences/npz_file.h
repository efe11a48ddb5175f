// Reads arrays from NumPy's `.npz` files (numpy.savez, numpy.savez_compressed): a zip archive with a `.npy`
// file for each array.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace rcme {

struct NpzArray {
  std::vector<size_t> shape;  // empty: a single number
  bool is_whole = false;      // type i4 or i8
  // In C order, finite or not. An integer beyond 2^53 becomes the nearest double.
  std::vector<double> values;
};
// "[3, 2]".
std::string FormatShape(const std::vector<size_t>& shape);

// Nothing that a file states is trusted: offsets and sizes are checked against the file before anything is
// allocated, and the CRC-32 of an array before it is parsed. Zip64, encryption and several disks are
// refused, and so are arrays other than little-endian f2, f4, f8, i4 and i8 in C order.
class NpzFile {
 public:
  static constexpr size_t kMaxBytes = size_t{256} << 20;      // of the file
  static constexpr size_t kMaxArrayBytes = size_t{64} << 20;  // of an array, decompressed
  static constexpr size_t kMaxArrays = 1000;
  static constexpr size_t kMaxDimensions = 8;

  // Reads the bytes of the file and its list of arrays. Each name in the list is compared with that in front
  // of the array. Throws InputError that names the path.
  explicit NpzFile(const std::string& path);

  bool Has(const std::string& name) const { return members_.contains(name); }
  std::string Place(const std::string& name) const;  // "FILE: array 'NAME'", for messages
  // Decompresses an array; arrays that are not read are not decompressed. Throws InputError that names file
  // and array, what is wrong and what is allowed, also if there is no such array.
  NpzArray Read(const std::string& name) const;

 private:
  struct Member {
    size_t method = 0, num_packed = 0, num_unpacked = 0, offset = 0;  // offset of its local header
    std::uint32_t crc = 0;
  };
  [[noreturn]] void Fail(const std::string& what) const;
  void ReadDirectory();
  size_t AddMember(size_t at);  // returns the offset of the next one
  std::string_view PackedBytes(const std::string& name, const Member& member) const;

  std::string path_, bytes_;
  size_t directory_ = 0, directory_end_ = 0;  // offsets
  std::map<std::string, Member> members_;     // by array name
};

// Parses the bytes of a `.npy` file. Throws InputError that begins with `place`.
NpzArray ParseNpy(std::string_view bytes, const std::string& place);

}  // namespace rcme
