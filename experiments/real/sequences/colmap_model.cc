#include "experiments/real/sequences/colmap_model.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <fstream>

#include "experiments/data/colmap_camera.h"
#include "experiments/real/sequences/layout_files.h"
#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;
using Lenses = std::map<std::int64_t, Lens>;
using Views = std::map<std::string, ColmapView>;

constexpr size_t kMaxNameBytes = 1023;

// Converts cam_from_world, COLMAP's convention.
CameraPose MakeCameraPose(const std::array<double, 7>& p, const std::string& place) {
  const Eigen::Quaterniond q(p[0], p[1], p[2], p[3]);
  const Eigen::Vector3d t(p[4], p[5], p[6]);
  if (!(std::abs(q.norm() - 1.0) < 1e-2))
    throw InputError(
        fmt::format("{}: a pose is damaged: a quaternion of length {:.4g}, not 1", place, q.norm()));
  if (!t.allFinite())
    throw InputError(fmt::format("{}: a pose is damaged: its translation is not finite", place));
  const Eigen::Matrix3d R = q.normalized().toRotationMatrix().transpose();
  return {R, -R * t};
}

void AddView(const std::string& name, const std::array<double, 7>& pose, std::int64_t camera,
             const Lenses& lenses, const std::string& place, Views* views) {
  const auto lens = lenses.find(camera);
  if (lens == lenses.end())
    throw InputError(fmt::format("{}: the camera {} of {} is not among the reconstruction's {}", place,
                                 camera, Quoted(name), lenses.size()));
  if (!views->emplace(name, ColmapView{MakeCameraPose(pose, place), lens->second}).second)
    throw InputError(fmt::format("{}: {} has two poses", place, Quoted(name)));
}

std::int64_t ReadWholeNumber(const TableFile& table, size_t field) {
  long long number = 0;
  if (!ParseInteger(table.fields().at(field), &number))
    table.Fail(fmt::format("{} is not a whole number", Quoted(table.fields()[field])));
  return number;
}

// Format: CAMERA_ID MODEL WIDTH HEIGHT PARAMS...
Lenses ReadCamerasText(const fs::path& path) {
  Lenses lenses;
  for (TableFile table(path, "it comes with images.txt", TableFile::Separator::kSpace); table.Next();) {
    table.Need(5, "CAMERA_ID MODEL WIDTH HEIGHT PARAMS...");
    const std::string place = fmt::format("{}: camera {}", path.string(), table.fields()[0]);
    ColmapCamera camera{ColmapModelNumber(table.fields()[1], place),
                        ReadWholeNumber(table, 2),
                        ReadWholeNumber(table, 3),
                        {}};
    for (size_t i = 4; i < table.fields().size(); ++i) camera.parameters.push_back(table.Number(i));
    lenses[ReadWholeNumber(table, 0)] = LensOfColmapCamera(camera, place);
  }
  return lenses;
}

// Format: IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, then a line of points, which may be empty.
Views ReadImagesText(const fs::path& path, const Lenses& lenses) {
  Views views;
  GzipLines lines(path.string(), {"reconstruction", "a reconstruction"});
  std::string_view line;
  while (lines.Next(&line)) {
    if (line.empty() || line == "\r" || line.front() == '#') continue;
    if (views.size() == size_t{TableFile::kMaxImages})
      lines.Fail(fmt::format("more than {} images are not read", TableFile::kMaxImages));
    std::array<double, 7> p{};
    char name[kMaxNameBytes + 1];
    unsigned id = 0, camera = 0;
    const std::string text(line);
    if (std::sscanf(text.c_str(), "%u %lf %lf %lf %lf %lf %lf %lf %u %1023[^\r\n]", &id, &p[0], &p[1], &p[2],
                    &p[3], &p[4], &p[5], &p[6], &camera, name) != 10)
      lines.Fail("is not IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME");
    AddView(name, p, camera, lenses, fmt::format("{}:{}", path.string(), lines.line_number()), &views);
    lines.Next(&line);
  }
  return views;
}

// Reads little-endian numbers one after another.
class Bytes {
 public:
  explicit Bytes(const fs::path& path) : path_(path.string()), file_(path, std::ios::binary) {
    std::error_code ignored;
    num_left_ = fs::file_size(path, ignored);
  }
  template <typename Number>
  Number Next() {
    Number number{};
    Need(sizeof(number));
    file_.read(reinterpret_cast<char*>(&number), sizeof(number));
    return number;
  }
  void Skip(std::uint64_t count, std::uint64_t size) {
    if (count > num_left_ / size) Need(num_left_ + 1);
    Need(count * size);
    file_.seekg(static_cast<std::streamoff>(count * size), std::ios::cur);
  }
  [[noreturn]] void Fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", path_, what));
  }
  const std::string& path() const { return path_; }

 private:
  void Need(std::uint64_t size) {
    if (!file_ || size > num_left_) Fail("ends early: it is cut off or damaged");
    num_left_ -= size;
  }
  std::string path_;
  std::ifstream file_;
  std::uint64_t num_left_ = 0;
};

Lenses ReadCamerasBinary(const fs::path& path) {
  CheckIsThere(path, "it comes with images.bin");
  Lenses lenses;
  Bytes bytes(path);
  for (auto left = bytes.Next<std::uint64_t>(); left > 0; --left) {
    const auto id = bytes.Next<std::uint32_t>();
    const std::string place = fmt::format("{}: camera {}", bytes.path(), id);
    ColmapCamera camera;
    camera.model = bytes.Next<std::int32_t>();
    camera.width = bytes.Next<std::int64_t>();
    camera.height = bytes.Next<std::int64_t>();
    for (size_t i = NumColmapParameters(camera.model, place); i > 0; --i)
      camera.parameters.push_back(bytes.Next<double>());
    lenses[id] = LensOfColmapCamera(camera, place);
  }
  return lenses;
}

Views ReadImagesBinary(const fs::path& path, const Lenses& lenses) {
  constexpr std::uint64_t kPointBytes = 2 * sizeof(double) + sizeof(std::int64_t);
  Views views;
  Bytes bytes(path);
  for (auto left = bytes.Next<std::uint64_t>(); left > 0; --left) {
    bytes.Next<std::uint32_t>();  // image
    std::array<double, 7> p{};
    for (double& x : p) x = bytes.Next<double>();
    const auto camera = bytes.Next<std::uint32_t>();
    std::string name;
    for (char c = bytes.Next<char>(); c != '\0'; c = bytes.Next<char>()) {
      if (name.size() == kMaxNameBytes)
        bytes.Fail(fmt::format("an image's name is longer than {} bytes: it is damaged", kMaxNameBytes));
      name += c;
    }
    bytes.Skip(bytes.Next<std::uint64_t>(), kPointBytes);
    AddView(name, p, camera, lenses, bytes.path(), &views);
  }
  return views;
}

}  // namespace

Views ReadColmapModel(const fs::path& folder) {
  if (fs::exists(folder / "images.bin"))
    return ReadImagesBinary(folder / "images.bin", ReadCamerasBinary(folder / "cameras.bin"));
  CheckIsThere(folder / "images.txt", "and neither is images.bin: this is not a reconstruction of COLMAP");
  return ReadImagesText(folder / "images.txt", ReadCamerasText(folder / "cameras.txt"));
}

}  // namespace rcme
