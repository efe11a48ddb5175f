// Arrays of NumPy's `.npz` files (numpy.savez, numpy.savez_compressed): a zip archive with a `.npy` file for
// each array.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace rcme {

struct NpzArray {
  std::vector<size_t> shape;  // empty: one number
  bool is_whole = false;      // i4 or i8
  // In C order, finite or not. A whole number beyond 2^53 is the nearest that a double has.
  std::vector<double> values;
};
// "[3, 2]".
std::string FormatShape(const std::vector<size_t>& shape);

// Of what a file says of itself nothing is believed unseen: offsets and sizes are checked against the file
// before anything is allocated, and an array's CRC-32 before it is looked at. What zip64, encryption or
// several disks would add is refused, and so are arrays other than little-endian f2, f4, f8, i4 and i8 in C
// order.
class NpzFile {
 public:
  static constexpr size_t kMaxBytes = size_t{256} << 20;      // of the file
  static constexpr size_t kMaxArrayBytes = size_t{64} << 20;  // of an array, unpacked
  static constexpr size_t kMaxArrays = 1000;
  static constexpr size_t kMaxDimensions = 8;

  // Reads the bytes of the file and its list of arrays, whose names are compared with those before them.
  // Throws InputError that names the path.
  explicit NpzFile(const std::string& path);

  bool Has(const std::string& name) const { return members_.contains(name); }
  std::string Place(const std::string& name) const;  // "FILE: array 'NAME'", for messages
  // Throws InputError that names file and array, what is wrong and what is allowed: also where there is none
  // of that name. Arrays that nobody asks for are not unpacked.
  NpzArray Read(const std::string& name) const;

 private:
  struct Member {
    size_t method = 0, num_packed = 0, num_unpacked = 0, offset = 0;  // offset of its local header
    std::uint32_t crc = 0;
  };
  [[noreturn]] void Fail(const std::string& what) const;
  void ReadDirectory();
  size_t AddMember(size_t at);  // where the next one begins
  std::string_view PackedBytes(const std::string& name, const Member& member) const;

  std::string path_, bytes_;
  size_t directory_ = 0, directory_end_ = 0;  // offsets
  std::map<std::string, Member> members_;     // by the array's name
};

// The array of the bytes of a `.npy` file. Throws InputError that begins with `place`.
NpzArray ParseNpy(std::string_view bytes, const std::string& place);

}  // namespace rcme
