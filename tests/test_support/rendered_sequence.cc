#include "tests/test_support/rendered_sequence.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <stdexcept>

#include "tests/test_support/png.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

// Axis-parallel boxes, metres, y down: the hall, seen from inside, and its pillars.
struct Box {
  Eigen::Vector3d min, max;
};
const Box kHall = {{-4.0, -2.5, -3.0}, {4.0, 1.5, 22.0}};
const std::array<Box, 6> kPillars = {{{{1.6, -2.5, 4.0}, {2.3, 1.5, 4.7}},
                                      {{2.4, -0.2, 6.5}, {3.4, 1.5, 7.3}},
                                      {{-2.2, -2.5, 7.5}, {-1.5, 1.5, 8.2}},
                                      {{1.8, -2.5, 9.5}, {2.5, 1.5, 10.2}},
                                      {{2.0, 0.3, 12.5}, {3.2, 1.5, 13.5}},
                                      {{-1.0, -2.5, 15.0}, {0.0, 1.5, 16.0}}}};

struct Hit {
  double distance = std::numeric_limits<double>::infinity();
  std::uint32_t face = 0;
  double u = 0.0, v = 0.0;  // on the face, metres
};

// The two crossings of a ray with each pair of faces: the last entry is where a box is met from outside, the
// first exit where it is left from inside.
void Meet(const Box& box, bool from_inside, std::uint32_t first_face, const Eigen::Vector3d& origin,
          const Eigen::Vector3d& ray, Hit* hit) {
  double entry = 0.0, exit = std::numeric_limits<double>::infinity();
  int entry_axis = 0, exit_axis = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (box.min[axis] - origin[axis]) / ray[axis],
                 b = (box.max[axis] - origin[axis]) / ray[axis];
    if (std::min(a, b) > entry) entry = std::min(a, b), entry_axis = axis;
    if (std::max(a, b) < exit) exit = std::max(a, b), exit_axis = axis;
  }
  if (!from_inside && (entry >= exit || entry <= 0.0)) return;
  const double distance = from_inside ? exit : entry;
  if (distance >= hit->distance) return;
  const int axis = from_inside ? exit_axis : entry_axis;
  const Eigen::Vector3d point = origin + distance * ray;
  const bool is_upper = (ray[axis] > 0.0) == from_inside;
  *hit = {distance, first_face + 2 * static_cast<std::uint32_t>(axis) + is_upper, point[(axis + 1) % 3],
          point[(axis + 2) % 3]};
}

// A number in [0, 1) for a lattice point of a face's wave (PCG's output permutation over a linear mix).
double LatticeValue(std::uint32_t face, int x, int y) {
  std::uint32_t h = face * 0x9E3779B9u + static_cast<std::uint32_t>(x) * 0x85EBCA6Bu +
                    static_cast<std::uint32_t>(y) * 0xC2B2AE35u;
  h ^= h >> 16;
  h *= 0x7FEB352Du;
  h ^= h >> 15;
  h *= 0x846CA68Bu;
  h ^= h >> 16;
  return h * 0x1p-32;
}

// Smooth noise between lattice points.
double Wave(std::uint32_t face, double u, double v) {
  const double fu = std::floor(u), fv = std::floor(v);
  const int x = static_cast<int>(fu), y = static_cast<int>(fv);
  const auto smooth = [](double t) { return t * t * (3.0 - 2.0 * t); };
  const double a = smooth(u - fu), b = smooth(v - fv);
  return (1.0 - b) * ((1.0 - a) * LatticeValue(face, x, y) + a * LatticeValue(face, x + 1, y)) +
         b * ((1.0 - a) * LatticeValue(face, x, y + 1) + a * LatticeValue(face, x + 1, y + 1));
}

// Waves of 0.64 to 0.02 m; each fades where it is shorter than three pixels.
double Texture(const Hit& hit, double metres_per_px) {
  double sum = 0.0;
  std::uint32_t octave = 0;
  for (double cell = 0.64; cell > 0.015; cell /= 2.0, ++octave) {
    const double weight = std::clamp(cell / (1.5 * metres_per_px) - 1.0, 0.0, 1.0);
    if (weight > 0.0) sum += weight * (Wave(hit.face * 8 + octave, hit.u / cell, hit.v / cell) - 0.5);
  }
  return 127.5 + 90.0 * sum;
}

// The ray (third component 1) through each of the points, by OpenCV.
std::vector<cv::Point2d> RaysThrough(const RenderedCamera& camera, const std::vector<cv::Point2d>& points) {
  const Camera& c = camera.camera;
  const cv::Matx33d K(c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1);
  const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 100, 1e-10);
  std::vector<cv::Point2d> rays;
  if (!camera.fisheye.empty()) {
    cv::fisheye::undistortPoints(points, rays, K, camera.fisheye, cv::noArray(), cv::noArray(), until);
  } else {
    const std::vector<double> none(4, 0.0);
    cv::undistortPoints(points, rays, K, camera.radtan.empty() ? none : camera.radtan, cv::noArray(),
                        cv::noArray(), until);
  }
  return rays;
}

std::ofstream Open(const fs::path& path) {
  fs::create_directories(path.parent_path());
  std::ofstream file(path);
  if (!file) throw std::runtime_error("cannot write " + path.string());
  return file;
}

void Render(const fs::path& path, const RenderedCamera& camera, int frame, std::uint32_t texture = 0) {
  fs::create_directories(path.parent_path());
  WriteImage(path.string(), camera.camera, RenderHall(camera, PoseOnWalk(frame), texture));
}

// [R t] row by row.
std::string AsRows(const Eigen::Matrix3d& R, const Eigen::Vector3d& t, const char* separator) {
  std::string text;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      if (!text.empty()) text += separator;
      text += fmt::format("{:.12e}", column < 3 ? R(row, column) : t[row]);
    }
  }
  return text;
}

}  // namespace

RenderedPose PoseOnWalk(double u) {
  RenderedPose pose;
  pose.center << 0.9 * std::sin(0.11 * u) - 0.8, 0.25 * std::sin(0.17 * u + 1.0), -1.0 + 0.09 * u;
  pose.R_world_from_cam = (Eigen::AngleAxisd(0.55 + 0.15 * std::sin(0.13 * u), Eigen::Vector3d::UnitY()) *
                           Eigen::AngleAxisd(0.06 * std::sin(0.21 * u), Eigen::Vector3d::UnitX()) *
                           Eigen::AngleAxisd(0.05 * std::sin(0.16 * u + 2.0), Eigen::Vector3d::UnitZ()))
                              .toRotationMatrix();
  return pose;
}

RelativePose TrueMotion(const RenderedPose& pose1, const RenderedPose& pose2) {
  const Eigen::Matrix3d& R2 = pose2.R_world_from_cam;
  return {R2.transpose() * pose1.R_world_from_cam,
          (R2.transpose() * (pose1.center - pose2.center)).normalized()};
}

std::vector<std::uint8_t> RenderHall(const RenderedCamera& camera, const RenderedPose& pose,
                                     std::uint32_t texture) {
  constexpr auto kNumFaces = static_cast<std::uint32_t>(6 * (kPillars.size() + 1));
  const Camera& c = camera.camera;
  std::vector<cv::Point2d> points;
  for (int y = 0; y < c.height; ++y) {
    for (int x = 0; x < c.width; ++x) {
      for (const double d : {-0.25, 0.25}) points.emplace_back(x + d, y + d);
    }
  }
  const std::vector<cv::Point2d> rays = RaysThrough(camera, points);
  std::vector<std::uint8_t> grey(rays.size() / 2);
  for (size_t pixel = 0; pixel < grey.size(); ++pixel) {
    double sum = 0.0;
    for (size_t k = 2 * pixel; k < 2 * pixel + 2; ++k) {
      const Eigen::Vector3d ray =
          pose.R_world_from_cam * Eigen::Vector3d(rays[k].x, rays[k].y, 1.0).normalized();
      Hit hit;
      Meet(kHall, true, 0, pose.center, ray, &hit);
      for (std::uint32_t p = 0; p < kPillars.size(); ++p)
        Meet(kPillars[p], false, 6 * (p + 1), pose.center, ray, &hit);
      hit.face += kNumFaces * texture;
      sum += Texture(hit, hit.distance / c.fx);
    }
    grey[pixel] = static_cast<std::uint8_t>(std::clamp(std::lround(sum / 2.0), 0L, 255L));
  }
  return grey;
}

void WriteImage(const std::string& path, const Camera& camera, std::vector<std::uint8_t> grey) {
  std::ofstream file(path, std::ios::binary);
  file << GreyPng(static_cast<std::uint32_t>(camera.width), grey);
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

void WriteKittiSequence(const std::string& folder, const std::string& name, const RenderedWalk& walk,
                        const RenderedCamera& camera) {
  const fs::path sequence = fs::path(folder) / "sequences" / name;
  std::ofstream calib = Open(sequence / "calib.txt"), times = Open(sequence / "times.txt");
  std::ofstream poses = Open(fs::path(folder) / "poses" / (name + ".txt"));
  Eigen::Matrix3d K = camera.camera.K();
  for (int i = 0; i < 4; ++i)
    calib << fmt::format("P{}: {}\n", i, AsRows(K, Eigen::Vector3d(-50.0 * i, 0.0, 0.0), " "));
  // The world is the first camera's frame, as in the data set.
  const RenderedPose first = PoseOnWalk(walk.first_frame);
  const Eigen::Matrix3d R_inverse = first.R_world_from_cam.transpose();
  for (int i = 0; i < walk.num_frames; ++i) {
    Render(sequence / "image_0" / fmt::format("{:06}.png", i), camera, walk.first_frame + i, walk.texture);
    times << fmt::format("{:e}\n", 0.1 * i);
    const RenderedPose pose = PoseOnWalk(walk.first_frame + i);
    poses << AsRows(R_inverse * pose.R_world_from_cam, R_inverse * (pose.center - first.center), " ") << '\n';
  }
}

void WriteEurocSequence(const std::string& folder, int num_frames, const RenderedCamera& camera) {
  constexpr std::int64_t kStart = 1403636579763555584, kPeriod = 50'000'000;  // ns
  const fs::path mav0 = fs::path(folder) / "mav0";
  const Eigen::Matrix3d body_from_cam =
      Eigen::AngleAxisd(1.5, Eigen::Vector3d(0.1, 0.2, 1.0).normalized()).toRotationMatrix();
  const Eigen::Vector3d cam_in_body(-0.0216, -0.0647, 0.0098);
  const Camera& c = camera.camera;
  Open(mav0 / "cam0" / "sensor.yaml")
      << "# General sensor definitions.\nsensor_type: camera\ncomment: rendered\n\nT_BS:\n  cols: 4\n  rows: "
         "4\n"
      << "  data: [" << AsRows(body_from_cam, cam_in_body, ", ") << ",\n         0.0, 0.0, 0.0, 1.0]\n\n"
      << "rate_hz: 20\n"
      << fmt::format("resolution: [{}, {}]\n", c.width, c.height) << "camera_model: pinhole\n"
      << fmt::format("intrinsics: [{}, {}, {}, {}] #fu, fv, cu, cv\n", c.fx, c.fy, c.cx, c.cy)
      << fmt::format("distortion_model: {}\n", camera.fisheye.empty() ? "radial-tangential" : "equidistant")
      << fmt::format("distortion_coefficients: [{}]\n",
                     fmt::join(camera.fisheye.empty() ? camera.radtan : camera.fisheye, ", "));
  std::ofstream data = Open(mav0 / "cam0" / "data.csv");
  data << "#timestamp [ns],filename\r\n";
  for (int i = 0; i < num_frames; ++i) {
    const std::string name = fmt::format("{}.png", kStart + i * kPeriod);
    Render(mav0 / "cam0" / "data" / name, camera, i);
    data << fmt::format("{},{}\r\n", kStart + i * kPeriod, name);
  }
  std::ofstream truth = Open(mav0 / "state_groundtruth_estimate0" / "data.csv");
  truth
      << "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], "
         "v_RS_R_x [m s^-1]\n";
  for (int k = -1; k <= 10 * num_frames; ++k) {
    const std::int64_t since = k * kPeriod / 10 + 2'000'000;
    const RenderedPose pose = PoseOnWalk(static_cast<double>(since) / static_cast<double>(kPeriod));
    const Eigen::Matrix3d R = pose.R_world_from_cam * body_from_cam.transpose();
    const Eigen::Vector3d p = pose.center - R * cam_in_body;
    const Eigen::Quaterniond q(R);
    truth << fmt::format("{},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},0.0\n", kStart + since, p.x(),
                         p.y(), p.z(), q.w(), q.x(), q.y(), q.z());
  }
}

void WriteTumSequence(const std::string& folder, int num_frames, const RenderedCamera& camera) {
  constexpr double kStart = 1305031102.1753, kPeriod = 1.0 / 30.0;  // s
  std::ofstream images = Open(fs::path(folder) / "rgb.txt"),
                truth = Open(fs::path(folder) / "groundtruth.txt");
  images << "# color images\n# file: 'rendered.bag'\n# timestamp filename\n";
  for (int i = 0; i < num_frames; ++i) {
    const double time = kStart + i * kPeriod;
    const std::string name = fmt::format("rgb/{:.6f}.png", time);
    Render(fs::path(folder) / name, camera, i);
    images << fmt::format("{:.6f} {}\n", time, name);
  }
  truth << "# ground truth trajectory\n# file: 'rendered.bag'\n# timestamp tx ty tz qx qy qz qw\n";
  for (double since = -0.003; since < (num_frames + 1) * kPeriod; since += 0.01) {
    const RenderedPose pose = PoseOnWalk(since / kPeriod);
    const Eigen::Quaterniond q(pose.R_world_from_cam);
    truth << fmt::format("{:.4f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f}\n", kStart + since,
                         pose.center.x(), pose.center.y(), pose.center.z(), q.x(), q.y(), q.z(), q.w());
  }
}

void WriteImageFolder(const std::string& folder, int num_frames, const RenderedCamera& camera) {
  for (int i = 0; i < num_frames; ++i) Render(fs::path(folder) / fmt::format("{:04}.png", i), camera, i);
}

}  // namespace rcme
