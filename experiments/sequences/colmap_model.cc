#include "experiments/sequences/colmap_model.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>

#include "experiments/sequences/layout_files.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

// From cam_from_world, as COLMAP stores it.
CameraPose PoseOf(const Eigen::Quaterniond& q, const Eigen::Vector3d& t, const std::string& place) {
  if (!(std::abs(q.norm() - 1.0) < 1e-2) || !t.allFinite())
    throw InputError(
        fmt::format("{}: a pose is damaged: a quaternion of length {:.4g}, not 1", place, q.norm()));
  const Eigen::Matrix3d R = q.normalized().toRotationMatrix().transpose();
  return {R, -R * t};
}

// IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, then a line of points, which may be empty.
std::map<std::string, CameraPose> ReadText(const fs::path& path) {
  std::map<std::string, CameraPose> poses;
  GzipLines lines(path.string(), {"reconstruction", "a reconstruction"});
  std::string_view line;
  while (lines.Next(&line)) {
    if (line.empty() || line.front() == '#') continue;
    std::array<double, 7> p{};
    char name[1024];
    unsigned id = 0, camera = 0;
    const std::string text(line);
    if (std::sscanf(text.c_str(), "%u %lf %lf %lf %lf %lf %lf %lf %u %1023[^\r\n]", &id, &p[0], &p[1], &p[2],
                    &p[3], &p[4], &p[5], &p[6], &camera, name) != 10)
      lines.Fail("is not IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME");
    poses[name] = PoseOf({p[0], p[1], p[2], p[3]}, {p[4], p[5], p[6]},
                         fmt::format("{}:{}", path.string(), lines.line_number()));
    lines.Next(&line);
  }
  return poses;
}

// Little-endian numbers one after another.
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

 private:
  void Need(std::uint64_t size) {
    if (!file_ || size > num_left_)
      throw InputError(fmt::format("{}: ends early: it is cut off or damaged", path_));
    num_left_ -= size;
  }
  std::string path_;
  std::ifstream file_;
  std::uint64_t num_left_ = 0;
};

std::map<std::string, CameraPose> ReadBinary(const fs::path& path) {
  constexpr std::uint64_t kPointBytes = 2 * sizeof(double) + sizeof(std::int64_t);
  std::map<std::string, CameraPose> poses;
  Bytes bytes(path);
  for (auto left = bytes.Next<std::uint64_t>(); left > 0; --left) {
    bytes.Next<std::uint32_t>();  // image
    std::array<double, 7> p{};
    for (double& x : p) x = bytes.Next<double>();
    bytes.Next<std::uint32_t>();  // camera
    std::string name;
    for (char c = bytes.Next<char>(); c != '\0'; c = bytes.Next<char>()) name += c;
    bytes.Skip(bytes.Next<std::uint64_t>(), kPointBytes);
    poses[name] = PoseOf({p[0], p[1], p[2], p[3]}, {p[4], p[5], p[6]}, path.string());
  }
  return poses;
}

}  // namespace

std::map<std::string, CameraPose> ReadColmapPoses(const fs::path& folder) {
  if (fs::exists(folder / "images.bin")) return ReadBinary(folder / "images.bin");
  CheckIsThere(folder / "images.txt", "and neither is images.bin: it is no reconstruction of COLMAP");
  return ReadText(folder / "images.txt");
}

}  // namespace rcme
