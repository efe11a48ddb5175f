// HDF5 files of pairs in the format of posebench. A separate process, which can open no other file, reads
// one pair at a time; this process interprets and checks the content.
#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>

#include "experiments/core/work/isolated_call.h"
#include "experiments/data/colmap_camera.h"
#include "experiments/real/sequences/layout_files.h"
#include "experiments/real/sequences/listed_pairs.h"
#include "experiments/real/sequences/posebench_file.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

using Packed = nlohmann::json;

constexpr size_t kReaderMemoryBytes = size_t{512} << 20;  // in addition to what the program uses
constexpr int kProcessorSeconds = 10;
constexpr double kReaderSeconds = 60.0;
// Limits over all pairs of a file: a group that occurs under a thousand names is decompressed a thousand
// times.
constexpr double kMaxNumbersPerByte = 12.5, kNumbersAlwaysAllowed = 1e6;

// Convert numbers to bytes and back.
Packed PackNumbers(const std::vector<double>& numbers) {
  Packed::binary_t bytes;
  bytes.resize(numbers.size() * sizeof(double));
  if (!numbers.empty()) std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}
// Reads the numbers of a key of the reply; `count` is their number if it is known. Throws std::exception if
// the reply is invalid.
std::vector<double> UnpackNumbers(const Packed& answer, const char* key, size_t count = 0) {
  const Packed::binary_t& bytes = answer.at(key).get_binary();
  std::vector<double> numbers(count > 0 ? count : bytes.size() / sizeof(double));
  if (numbers.size() * sizeof(double) != bytes.size()) throw std::length_error(key);
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(double));
  return numbers;
}

Packed PackCamera(const StoredCamera& camera) {
  return {{"model", Packed::binary({camera.model.begin(), camera.model.end()})},
          {"size", PackNumbers({camera.width, camera.height})},
          {"params", PackNumbers(camera.params)}};
}
StoredCamera UnpackCamera(const Packed& packed) {
  const Packed::binary_t& model = packed.at("model").get_binary();
  const std::vector<double> size = UnpackNumbers(packed, "size", 2);
  return {{model.begin(), model.end()}, size[0], size[1], UnpackNumbers(packed, "params")};
}

Packed PackPair(const StoredPair& pair) {
  return {{"x1", PackNumbers(pair.x1)},
          {"x2", PackNumbers(pair.x2)},
          {"R", PackNumbers(pair.R)},
          {"t", PackNumbers(pair.t)},
          {"camera1", PackCamera(pair.camera1)},
          {"camera2", PackCamera(pair.camera2)}};
}
StoredPair UnpackPair(const Packed& packed) {
  return {UnpackNumbers(packed, "x1"),        UnpackNumbers(packed, "x2"),
          UnpackNumbers(packed, "R", 9),      UnpackNumbers(packed, "t", 3),
          UnpackCamera(packed.at("camera1")), UnpackCamera(packed.at("camera2"))};
}

// Runs `read` in a separate process and passes its packed result to `take` in this one. A file that crashes
// its reader, takes too much memory or does not end causes an InputError that begins with `place`.
void ReadApart(const std::string& path, const std::string& place,
               const std::function<Packed(const PosebenchFile&)>& read,
               const std::function<void(const Packed&)>& take) {
  const auto work = [&](const Announce&) -> std::string {
    Packed answer;
    try {
      LimitProcess(kReaderMemoryBytes, kProcessorSeconds);
      const PosebenchFile file(path);
      ForbidOpeningFiles();
      answer = read(file);
    } catch (const InputError& error) {
      answer = {{"error", error.what()}};
    } catch (const std::bad_alloc&) {
      answer = {{"error", fmt::format("{}: reading it takes more than {} MB of memory: it is damaged", place,
                                      kReaderMemoryBytes >> 20)}};
    }
    std::string bytes;
    Packed::to_cbor(answer, bytes);
    return bytes;
  };
  const IsolatedEnd end = RunIsolated(work, kReaderSeconds);
  const Packed answer = Packed::from_cbor(end.result, true, false);
  if (answer.contains("error") && answer.at("error").is_string())
    throw InputError(answer.at("error").get<std::string>());
  try {
    if (end.kind == IsolatedEnd::Kind::kDone) return take(answer);
  } catch (const std::exception&) {
    // The reply is invalid.
  }
  throw InputError(fmt::format("{}: is damaged, perhaps on purpose: the process that read it {}", place,
                               end.kind == IsolatedEnd::Kind::kSignal
                                   ? fmt::format("was ended by signal {} ({})", end.code, strsignal(end.code))
                                   : DescribeEnd(end, kReaderSeconds)));
}

void CheckFinite(const std::vector<double>& numbers, const char* name, const std::string& place) {
  for (const double value : numbers) {
    if (!std::isfinite(value))
      throw InputError(fmt::format("{}: {} holds a number that is not finite", place, name));
  }
}

std::vector<Eigen::Vector2d> MakePoints(const std::vector<double>& stored, const char* name,
                                        const std::string& place) {
  CheckFinite(stored, name, place);
  std::vector<Eigen::Vector2d> points;
  for (size_t i = 0; i + 1 < stored.size(); i += 2)
    points.emplace_back(stored[i] - kColmapHalfPixel, stored[i + 1] - kColmapHalfPixel);
  return points;
}

std::int64_t CheckLength(double value, const char* name, const std::string& place) {
  if (!(value >= 0.0 && value <= 1e9 && value == std::floor(value)))
    throw InputError(fmt::format("{}: {} is {}; a whole number of pixels is needed", place, name, value));
  return static_cast<std::int64_t>(value);
}

Lens MakeStoredLens(const StoredCamera& stored, const std::string& place) {
  ColmapCamera camera;
  camera.model = ColmapModelNumber(stored.model, place);
  camera.width = CheckLength(stored.width, "width", place);
  camera.height = CheckLength(stored.height, "height", place);
  CheckFinite(stored.params, "params", place);
  const size_t num_params = NumColmapParameters(camera.model, place);
  if (stored.params.size() != num_params)
    throw InputError(
        fmt::format("{}: params holds {} numbers; {} are needed", place, stored.params.size(), num_params));
  camera.parameters = stored.params;
  return LensOfColmapCamera(camera, place);
}

void FillMatches(const StoredPair& stored, const std::string& place, MatchFile* file) {
  const std::vector<Eigen::Vector2d> x1 = MakePoints(stored.x1, "x1", place),
                                     x2 = MakePoints(stored.x2, "x2", place);
  if (x1.size() != x2.size())
    throw InputError(fmt::format("{}: x1 holds {} points, x2 {}", place, x1.size(), x2.size()));
  const Lens lens1 = MakeStoredLens(stored.camera1, place + ": camera1"),
             lens2 = MakeStoredLens(stored.camera2, place + ": camera2");
  file->camera1 = lens1.camera;
  file->camera2 = lens2.camera;
  for (size_t i = 0; i < x1.size(); ++i) {
    const auto ideal1 = Undistort(lens1, x1[i]), ideal2 = Undistort(lens2, x2[i]);
    if (ideal1 && ideal2) file->matches.push_back({*ideal1, *ideal2});
  }
}

// X2 = R X1 + t; the unit of t is not stated.
void FillMotion(const StoredPair& stored, const std::string& place, ListedPair* listed) {
  CheckFinite(stored.R, "R", place);
  CheckFinite(stored.t, "t", place);
  const Eigen::Matrix3d R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(stored.R.data());
  if (!((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3) || R.determinant() < 0.0)
    throw InputError(fmt::format("{}: R is not a rotation", place));
  const Eigen::Vector3d translation(stored.t[0], stored.t[1], stored.t[2]);
  listed->is_direction_weak = !(translation.norm() > 0.0);
  listed->file.cam2_from_cam1_true = {
      R, listed->is_direction_weak ? Eigen::Vector3d(Eigen::Vector3d::UnitZ()) : translation.normalized()};
}

class PosebenchPairs : public ListedPairs {
 public:
  explicit PosebenchPairs(const DatasetOptions& options)
      : path_(options.folder),
        scene_(options.name.empty() ? std::filesystem::path(path_).stem().string() : options.name) {
    CheckIsThere(path_, "give an HDF5 file of posebench");
    RegularFile(path_, {"HDF5 file", "an HDF5 file"});
    const auto num_bytes = static_cast<double>(std::filesystem::file_size(path_));
    num_numbers_left_ = kNumbersAlwaysAllowed + kMaxNumbersPerByte * num_bytes;
    names_ = ReadNames(path_);
    if (names_.empty()) throw InputError(fmt::format("{}: holds no pairs", path_));
  }

  size_t size() const override { return names_.size(); }
  std::string PairId(size_t i) const override { return fmt::format("{}_{:06}", scene_, i); }
  ListedPair Read(size_t i) override {
    const std::string& name = names_.at(i);
    const std::string place = fmt::format("{}: group {}", path_, Quoted(name));
    StoredPair stored;
    ReadApart(
        path_, place, [&](const PosebenchFile& file) { return PackPair(file.ReadGroup(name)); },
        [&](const Packed& answer) { stored = UnpackPair(answer); });
    CountNumbers(stored, place);
    ListedPair listed;
    listed.file.scene = scene_;
    FillMatches(stored, place, &listed.file);
    FillMotion(stored, place, &listed);
    return listed;
  }

 private:
  // Names may contain any bytes.
  static std::vector<std::string> ReadNames(const std::string& path) {
    const auto list = [](const PosebenchFile& file) {
      Packed names = Packed::array();
      for (const std::string& name : file.ListGroups())
        names.push_back(Packed::binary({name.begin(), name.end()}));
      return Packed{{"names", std::move(names)}};
    };
    std::vector<std::string> names;
    ReadApart(path, path, list, [&](const Packed& answer) {
      for (const Packed& name : answer.at("names")) {
        const Packed::binary_t& bytes = name.get_binary();
        names.emplace_back(bytes.begin(), bytes.end());
      }
    });
    return names;
  }

  void CountNumbers(const StoredPair& pair, const std::string& place) {
    num_numbers_left_ -= static_cast<double>(pair.x1.size() + pair.x2.size());
    if (num_numbers_left_ < 0.0)
      throw InputError(
          fmt::format("{}: the file's pairs so far unpack to more than a hundred times its size: it is "
                      "damaged, perhaps on purpose",
                      place));
  }

  std::string path_, scene_;
  std::vector<std::string> names_;  // in their order
  double num_numbers_left_ = 0.0;
};

}  // namespace

std::unique_ptr<ListedPairs> OpenPosebench(const DatasetOptions& options) {
  return std::make_unique<PosebenchPairs>(options);
}

}  // namespace rcme
