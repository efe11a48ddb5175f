// HDF5 files of pairs as posebench keeps them: a group per pair with x1, x2 (N x 2), R (3 x 3), t (3) and the
// groups camera1, camera2 with model, width, height, params.
#include <fmt/format.h>
#include <hdf5.h>

#include <Eigen/LU>
#include <cmath>
#include <memory>

#include "experiments/data/match_file.h"
#include "experiments/sequences/colmap_camera.h"
#include "experiments/sequences/layout_files.h"
#include "experiments/sequences/listed_pairs.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

constexpr size_t kMaxPosebenchPairs = 1'000'000, kMaxHdf5NameBytes = 1000, kMaxModelNameBytes = 64;

// An identifier of the library, closed when it goes. Negative: what was asked for is not there.
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

// An entry of a group that is in this file: links to others are not followed.
void CheckIsHere(hid_t group, const char* name, const std::string& place) {
  H5L_info_t link;
  if (H5Lget_info(group, name, &link, H5P_DEFAULT) < 0)
    throw InputError(fmt::format("{}: {} is not there", place, name));
  if (link.type != H5L_TYPE_HARD)
    throw InputError(fmt::format("{}: {} is a link to elsewhere; links are not followed", place, name));
}

// A dataset of at most this many numbers, row by row, and its shape.
struct Hdf5Numbers {
  std::vector<double> values;
  std::vector<hsize_t> shape;
};
Hdf5Numbers NumbersOf(hid_t group, const char* name, size_t most, const std::string& place) {
  CheckIsHere(group, name, place);
  const Hdf5Id data(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose);
  if (data < 0) throw InputError(fmt::format("{}: {} is no dataset", place, name));
  const Hdf5Id type(H5Dget_type(data), H5Tclose), space(H5Dget_space(data), H5Sclose);
  const H5T_class_t kind = H5Tget_class(type);
  if (kind != H5T_FLOAT && kind != H5T_INTEGER)
    throw InputError(fmt::format("{}: {} does not hold numbers", place, name));
  Hdf5Numbers numbers;
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 0 || rank > 2) throw InputError(fmt::format("{}: {} has {} dimensions", place, name, rank));
  numbers.shape.resize(static_cast<size_t>(rank));
  H5Sget_simple_extent_dims(space, numbers.shape.data(), nullptr);
  size_t count = 1;
  for (const hsize_t length : numbers.shape) {
    if (length > most || count * length > most)
      throw InputError(fmt::format("{}: {} holds more than {} numbers", place, name, most));
    count *= length;
  }
  numbers.values.resize(count);
  if (count > 0 && H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.values.data()) < 0)
    throw InputError(fmt::format("{}: {} cannot be read: the file is cut off or damaged", place, name));
  for (const double value : numbers.values) {
    if (!std::isfinite(value))
      throw InputError(fmt::format("{}: {} holds a number that is not finite", place, name));
  }
  return numbers;
}

// As many numbers, of any shape.
std::vector<double> NumbersOfCount(hid_t group, const char* name, size_t count, const std::string& place) {
  Hdf5Numbers numbers = NumbersOf(group, name, 10 * count, place);
  if (numbers.values.size() != count)
    throw InputError(
        fmt::format("{}: {} holds {} numbers; {} are needed", place, name, numbers.values.size(), count));
  return std::move(numbers.values);
}

std::vector<Eigen::Vector2d> PointsOf(hid_t group, const char* name, const std::string& place) {
  const Hdf5Numbers numbers = NumbersOf(group, name, 2 * kMaxMatchesPerFile, place);
  if (numbers.shape.size() != 2 || numbers.shape[1] != 2)
    throw InputError(fmt::format("{}: {} is not of N x 2 numbers", place, name));
  std::vector<Eigen::Vector2d> points;
  for (size_t i = 0; i < numbers.values.size(); i += 2)
    points.emplace_back(numbers.values[i] - kColmapHalfPixel, numbers.values[i + 1] - kColmapHalfPixel);
  return points;
}

// The first text of a dataset, of a fixed length or not.
std::string TextOf(hid_t group, const char* name, const std::string& place) {
  CheckIsHere(group, name, place);
  const Hdf5Id data(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose);
  if (data < 0) throw InputError(fmt::format("{}: {} is no dataset", place, name));
  const Hdf5Id type(H5Dget_type(data), H5Tclose), space(H5Dget_space(data), H5Sclose);
  const size_t size = H5Tget_size(type);
  if (H5Tget_class(type) != H5T_STRING || H5Sget_simple_extent_npoints(space) != 1 ||
      size > kMaxModelNameBytes)
    throw InputError(fmt::format("{}: {} is not one short text", place, name));
  if (H5Tis_variable_str(type) <= 0) {
    std::string text(size, '\0');
    if (H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0)
      throw InputError(fmt::format("{}: {} cannot be read", place, name));
    return text.substr(0, text.find('\0'));
  }
  char* text = nullptr;
  if (H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &text) < 0 || !text)
    throw InputError(fmt::format("{}: {} cannot be read", place, name));
  const std::string copy(text, strnlen(text, kMaxModelNameBytes));
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, &text);
  return copy;
}

Lens LensOfGroup(hid_t pair, const char* name, const std::string& place) {
  CheckIsHere(pair, name, place);
  const Hdf5Id group(H5Gopen2(pair, name, H5P_DEFAULT), H5Gclose);
  if (group < 0) throw InputError(fmt::format("{}: {} is no group", place, name));
  const std::string here = fmt::format("{}: {}", place, name);
  ColmapCamera camera;
  camera.model = ColmapModelNumber(TextOf(group, "model", here), here);
  for (const auto& [length, key] : {std::pair{&camera.width, "width"}, std::pair{&camera.height, "height"}}) {
    const double value = NumbersOfCount(group, key, 1, here)[0];
    if (!(value >= 0.0 && value <= 1e9 && value == std::floor(value)))
      throw InputError(fmt::format("{}: {} is {}; a whole number of pixels is needed", here, key, value));
    *length = static_cast<std::int64_t>(value);
  }
  camera.parameters = NumbersOfCount(group, "params", NumColmapParameters(camera.model, here), here);
  return LensOfColmapCamera(camera, here);
}

class PosebenchPairs : public ListedPairs {
 public:
  explicit PosebenchPairs(const DatasetOptions& options)
      : path_(options.folder),
        scene_(options.name.empty() ? std::filesystem::path(path_).stem().string() : options.name),
        file_(Open(path_), H5Fclose) {
    const Hdf5Id root(H5Gopen2(file_, "/", H5P_DEFAULT), H5Gclose);
    if (root < 0 || H5Literate(root, H5_INDEX_NAME, H5_ITER_INC, nullptr, AddName, &names_) < 0)
      throw InputError(
          fmt::format("{}: its groups cannot be listed: it is damaged, or has more than {} pairs or names "
                      "of more than {} bytes",
                      path_, kMaxPosebenchPairs, kMaxHdf5NameBytes));
    if (names_.empty()) throw InputError(fmt::format("{}: holds no pairs", path_));
  }

  size_t size() const override { return names_.size(); }
  std::string IdOf(size_t i) const override { return fmt::format("{}_{:06}", scene_, i); }
  ListedPair Read(size_t i) override {
    const std::string place = fmt::format("{}: group {}", path_, Quoted(names_.at(i)));
    CheckIsHere(file_, names_[i].c_str(), place);
    const Hdf5Id pair(H5Gopen2(file_, names_[i].c_str(), H5P_DEFAULT), H5Gclose);
    if (pair < 0) throw InputError(fmt::format("{}: is no group; a group per pair is needed", place));
    ListedPair listed;
    listed.file.scene = scene_;
    ReadMatches(pair, place, &listed.file);
    ReadMotion(pair, place, &listed);
    return listed;
  }

 private:
  static hid_t Open(const std::string& path) {
    CheckIsThere(path, "give an HDF5 file of posebench");
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // what is wrong is said here
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file < 0)
      throw InputError(
          fmt::format("{}: cannot be read as an HDF5 file: it is cut off, damaged or something else", path));
    return file;
  }
  static herr_t AddName(hid_t, const char* name, const H5L_info_t*, void* names) {
    auto* all = static_cast<std::vector<std::string>*>(names);
    if (all->size() == kMaxPosebenchPairs || strnlen(name, kMaxHdf5NameBytes + 1) > kMaxHdf5NameBytes)
      return -1;
    all->emplace_back(name);
    return 0;
  }

  static void ReadMatches(hid_t pair, const std::string& place, MatchFile* file) {
    const std::vector<Eigen::Vector2d> x1 = PointsOf(pair, "x1", place), x2 = PointsOf(pair, "x2", place);
    if (x1.size() != x2.size())
      throw InputError(fmt::format("{}: x1 holds {} points, x2 {}", place, x1.size(), x2.size()));
    const Lens lens1 = LensOfGroup(pair, "camera1", place), lens2 = LensOfGroup(pair, "camera2", place);
    file->camera1 = lens1.camera;
    file->camera2 = lens2.camera;
    for (size_t i = 0; i < x1.size(); ++i) {
      const auto ideal1 = Undistort(lens1, x1[i]), ideal2 = Undistort(lens2, x2[i]);
      if (ideal1 && ideal2) file->matches.push_back({*ideal1, *ideal2});
    }
  }

  // X2 = R X1 + t; the unit of t is not said.
  static void ReadMotion(hid_t pair, const std::string& place, ListedPair* listed) {
    const std::vector<double> r = NumbersOfCount(pair, "R", 9, place),
                              t = NumbersOfCount(pair, "t", 3, place);
    const Eigen::Matrix3d R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(r.data());
    if (!((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3) || R.determinant() < 0.0)
      throw InputError(fmt::format("{}: R is not a rotation", place));
    const Eigen::Vector3d translation(t[0], t[1], t[2]);
    listed->is_direction_weak = !(translation.norm() > 0.0);
    listed->file.cam2_from_cam1_true = {
        R, listed->is_direction_weak ? Eigen::Vector3d(Eigen::Vector3d::UnitZ()) : translation.normalized()};
  }

  std::string path_, scene_;
  Hdf5Id file_;
  std::vector<std::string> names_;  // in their order
};

}  // namespace

std::unique_ptr<ListedPairs> OpenPosebench(const DatasetOptions& options) {
  return std::make_unique<PosebenchPairs>(options);
}

}  // namespace rcme
