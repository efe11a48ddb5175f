// HDF5 files of pairs as posebench keeps them: a group per pair with x1, x2 (N x 2), R (3 x 3), t (3) and the
// groups camera1, camera2 with model, width, height, params.
#include "experiments/real/sequences/posebench_file.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>

#include "experiments/data/match_file.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

constexpr size_t kMaxPosebenchPairs = 1'000'000, kMaxHdf5NameBytes = 1000, kMaxModelNameBytes = 64;
constexpr size_t kMaxAllNamesBytes = size_t{64} << 20;
constexpr size_t kMaxCameraParams = 12;
// Limits for a dataset and for one of its chunks. gzip compresses coordinates less than tenfold, but zeros a
// thousandfold.
constexpr double kMaxUnpackedPerStored = 100.0, kAlwaysAllowedBytes = 65'536.0, kMaxUnpackedBytes = 32e6;

// An identifier of the library, closed on destruction. Negative: the requested object does not exist.
class Hdf5Id {
 public:
  Hdf5Id(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Hdf5Id() {
    if (id_ >= 0) close_(id_);
  }
  Hdf5Id(const Hdf5Id&) = delete;
  Hdf5Id& operator=(const Hdf5Id&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

[[noreturn]] void RefuseDamaged(const char* name, const std::string& place) {
  throw InputError(fmt::format("{}: {} cannot be read: the file is cut off or damaged", place, name));
}

// Returns an entry of a group that is in this file; links to other files are not followed.
void CheckIsHere(hid_t group, const char* name, const std::string& place) {
  H5L_info_t link;
  if (H5Lget_info(group, name, &link, H5P_DEFAULT) < 0)
    throw InputError(fmt::format("{}: {} is not there", place, name));
  if (link.type != H5L_TYPE_HARD)
    throw InputError(fmt::format("{}: {} is a link to elsewhere; links are not followed", place, name));
}

// Returns the bytes of a chunk, which is decompressed as a whole; 0 if the dataset is not chunked.
double CountChunkBytes(hid_t how, size_t number_bytes) {
  if (H5Pget_layout(how) != H5D_CHUNKED) return 0.0;
  hsize_t chunk[H5S_MAX_RANK] = {};
  const int rank = H5Pget_chunk(how, H5S_MAX_RANK, chunk);
  double num_bytes = static_cast<double>(number_bytes);
  for (int i = 0; i < rank; ++i) num_bytes *= static_cast<double>(chunk[i]);
  return num_bytes;
}

void CheckFilters(hid_t how, const char* name, const std::string& place) {
  const int num_filters = H5Pget_nfilters(how);
  for (int i = 0; i < num_filters; ++i) {
    unsigned flags = 0, config = 0;
    size_t num_values = 0;
    const H5Z_filter_t filter =
        H5Pget_filter2(how, static_cast<unsigned>(i), &flags, &num_values, nullptr, 0, nullptr, &config);
    if (filter == H5Z_FILTER_DEFLATE || filter == H5Z_FILTER_SHUFFLE || filter == H5Z_FILTER_FLETCHER32)
      continue;
    throw InputError(fmt::format(
        "{}: {} is packed by filter {}; gzip, shuffle and fletcher32 are read, and `h5repack -f GZIP=4 "
        "FILE NEW` packs it so",
        place, name, static_cast<int>(filter)));
  }
}

// Checks that the dataset lies in this file, has only the filters allowed here, and has a bounded
// decompressed size.
void CheckStorage(hid_t data, const char* name, size_t count, size_t number_bytes, const std::string& place) {
  const Hdf5Id how(H5Dget_create_plist(data), H5Pclose);
  const H5D_layout_t layout = H5Pget_layout(how);
  if (H5Pget_external_count(how) != 0 || layout == H5D_VIRTUAL) {
    throw InputError(fmt::format(
        "{}: {} is kept in another file, and no other file is read; copy the numbers into this one", place,
        name));
  }
  if (layout != H5D_COMPACT && layout != H5D_CONTIGUOUS && layout != H5D_CHUNKED) RefuseDamaged(name, place);
  CheckFilters(how, name, place);
  const double stored = static_cast<double>(H5Dget_storage_size(data)),
               unpacked =
                   std::max(static_cast<double>(count * number_bytes), CountChunkBytes(how, number_bytes));
  if (unpacked > std::min(kMaxUnpackedBytes, kAlwaysAllowedBytes + kMaxUnpackedPerStored * stored)) {
    throw InputError(fmt::format(
        "{}: {} takes {:.0f} bytes and would unpack to {:.0f}; up to {:.0f} times as many are read, and "
        "at most {:.0f} MB at once",
        place, name, stored, unpacked, kMaxUnpackedPerStored, kMaxUnpackedBytes / 1e6));
  }
}

// Returns the lengths of a dataset of up to two dimensions.
std::vector<hsize_t> ReadShape(hid_t data, const char* name, const std::string& place) {
  const Hdf5Id space(H5Dget_space(data), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 0 || rank > 2) throw InputError(fmt::format("{}: {} has {} dimensions", place, name, rank));
  if (H5Sget_simple_extent_type(space) == H5S_NULL) return {0};
  std::vector<hsize_t> shape(static_cast<size_t>(rank));
  H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  return shape;
}

// Reads a dataset of at most this many numbers, row by row, and its shape.
struct Hdf5Numbers {
  std::vector<double> values;
  std::vector<hsize_t> shape;
};
Hdf5Numbers ReadNumbers(hid_t group, const char* name, size_t most, const std::string& place) {
  CheckIsHere(group, name, place);
  const Hdf5Id data(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose);
  if (data < 0) throw InputError(fmt::format("{}: {} is no dataset", place, name));
  const Hdf5Id type(H5Dget_type(data), H5Tclose);
  const H5T_class_t kind = H5Tget_class(type);
  const size_t number_bytes = H5Tget_size(type);
  if ((kind != H5T_FLOAT && kind != H5T_INTEGER) || number_bytes == 0 || number_bytes > sizeof(double))
    throw InputError(fmt::format("{}: {} does not hold numbers of up to 64 bits", place, name));
  Hdf5Numbers numbers{{}, ReadShape(data, name, place)};
  size_t count = 1;
  for (const hsize_t length : numbers.shape) {
    if (length > most || count * length > most)
      throw InputError(fmt::format("{}: {} holds more than {} numbers", place, name, most));
    count *= length;
  }
  CheckStorage(data, name, count, number_bytes, place);
  numbers.values.resize(count);
  if (count > 0 && H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.values.data()) < 0)
    RefuseDamaged(name, place);
  return numbers;
}

// Reads this many numbers, of any shape.
std::vector<double> ReadCount(hid_t group, const char* name, size_t count, const std::string& place) {
  Hdf5Numbers numbers = ReadNumbers(group, name, 10 * count, place);
  if (numbers.values.size() != count)
    throw InputError(
        fmt::format("{}: {} holds {} numbers; {} are needed", place, name, numbers.values.size(), count));
  return std::move(numbers.values);
}

// Reads N x 2 numbers, row by row.
std::vector<double> ReadPoints(hid_t group, const char* name, const std::string& place) {
  Hdf5Numbers numbers = ReadNumbers(group, name, 2 * kMaxMatchesPerFile, place);
  if (numbers.shape.size() != 2 || numbers.shape[1] != 2)
    throw InputError(fmt::format("{}: {} is not of N x 2 numbers", place, name));
  return std::move(numbers.values);
}

// Reads the only text of a dataset, of fixed or variable length.
std::string ReadText(hid_t group, const char* name, const std::string& place) {
  CheckIsHere(group, name, place);
  const Hdf5Id data(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose);
  if (data < 0) throw InputError(fmt::format("{}: {} is no dataset", place, name));
  const Hdf5Id type(H5Dget_type(data), H5Tclose), space(H5Dget_space(data), H5Sclose);
  const size_t size = H5Tget_size(type);
  if (H5Tget_class(type) != H5T_STRING || H5Sget_simple_extent_npoints(space) != 1 ||
      size > kMaxModelNameBytes)
    throw InputError(fmt::format("{}: {} is not one short text", place, name));
  CheckStorage(data, name, 1, size, place);
  if (H5Tis_variable_str(type) <= 0) {
    std::string text(size, '\0');
    if (H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0) RefuseDamaged(name, place);
    return text.substr(0, text.find('\0'));
  }
  char* text = nullptr;
  if (H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &text) < 0 || !text) RefuseDamaged(name, place);
  std::string copy(text, strnlen(text, kMaxModelNameBytes));
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, &text);
  return copy;
}

StoredCamera ReadCamera(hid_t pair, const char* name, const std::string& place) {
  CheckIsHere(pair, name, place);
  const Hdf5Id group(H5Gopen2(pair, name, H5P_DEFAULT), H5Gclose);
  if (group < 0) throw InputError(fmt::format("{}: {} is no group", place, name));
  const std::string here = fmt::format("{}: {}", place, name);
  StoredCamera camera;
  camera.model = ReadText(group, "model", here);
  camera.width = ReadCount(group, "width", 1, here)[0];
  camera.height = ReadCount(group, "height", 1, here)[0];
  camera.params = ReadNumbers(group, "params", kMaxCameraParams, here).values;
  return camera;
}

struct GroupNames {
  std::vector<std::string> names;
  size_t num_bytes = 0;
};
herr_t AddName(hid_t, const char* name, const H5L_info_t*, void* names) {
  auto* all = static_cast<GroupNames*>(names);
  const size_t length = strnlen(name, kMaxHdf5NameBytes + 1);
  all->num_bytes += length;
  if (all->names.size() == kMaxPosebenchPairs || length > kMaxHdf5NameBytes ||
      all->num_bytes > kMaxAllNamesBytes)
    return -1;
  all->names.emplace_back(name);
  return 0;
}

// Opens the file on disk without the library's other drivers, messages and plugins.
hid_t OpenFile(const std::string& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  H5PLset_loading_state(0);
  const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_sec2(access);
  return H5Fopen(path.c_str(), H5F_ACC_RDONLY, access);
}

}  // namespace

struct PosebenchFile::Handle {
  explicit Handle(const std::string& path) : id(OpenFile(path), H5Fclose) {}
  Hdf5Id id;
};

PosebenchFile::PosebenchFile(const std::string& path) : path_(path), file_(std::make_unique<Handle>(path)) {
  if (file_->id < 0)
    throw InputError(
        fmt::format("{}: cannot be read as an HDF5 file: it is cut off, damaged or something else", path));
}
PosebenchFile::~PosebenchFile() = default;

std::vector<std::string> PosebenchFile::ListGroups() const {
  GroupNames found;
  const Hdf5Id root(H5Gopen2(file_->id, "/", H5P_DEFAULT), H5Gclose);
  if (root < 0 || H5Literate(root, H5_INDEX_NAME, H5_ITER_INC, nullptr, AddName, &found) < 0)
    throw InputError(
        fmt::format("{}: its groups cannot be listed: it is damaged, or has more than {} pairs or names "
                    "of more than {} bytes",
                    path_, kMaxPosebenchPairs, kMaxHdf5NameBytes));
  return std::move(found.names);
}

StoredPair PosebenchFile::ReadGroup(const std::string& name) const {
  const std::string place = fmt::format("{}: group {}", path_, Quoted(name));
  CheckIsHere(file_->id, name.c_str(), place);
  const Hdf5Id group(H5Gopen2(file_->id, name.c_str(), H5P_DEFAULT), H5Gclose);
  if (group < 0) throw InputError(fmt::format("{}: is not a group; a group per pair is needed", place));
  StoredPair pair;
  pair.x1 = ReadPoints(group, "x1", place);
  pair.x2 = ReadPoints(group, "x2", place);
  pair.camera1 = ReadCamera(group, "camera1", place);
  pair.camera2 = ReadCamera(group, "camera2", place);
  pair.R = ReadCount(group, "R", 9, place);
  pair.t = ReadCount(group, "t", 3, place);
  return pair;
}

}  // namespace rcme
