// What tests of scenes share: a world without a generator around it, and its candidates before any image
// decides which of them are kept.
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "parameters/parameter.h"
#include "simulator/cameras/camera_models.h"
#include "simulator/scene_generator.h"
#include "simulator/scene_model.h"
#include "tests/test_support/goodness_of_fit.h"

namespace rcme {

using Settings = std::vector<std::pair<std::string, std::string>>;  // key, value

template <typename Configurable>
void Set(Configurable& model, const Settings& settings) {
  for (const auto& [key, value] : settings) FindParameter(model.Parameters(), key).SetFromText(value);
}

inline std::unique_ptr<SceneModel> Configured(std::unique_ptr<SceneModel> model, const Settings& settings) {
  Set(*model, settings);
  return model;
}

inline Scene Generate(SceneGenerator& generator, std::uint32_t trial) {
  RandomStream rng({1, 0, trial, 1});
  return generator.Generate(rng);
}

// Twice the default camera (640 x 480, f 700 px) in one place: both images show the same.
inline ViewPair StillView() {
  ViewPair view;
  std::tie(view.camera1, view.camera2) = MakePinhole()->Make();
  return view;
}

// The world of a trial, seen by StillView().
inline std::unique_ptr<const World> DrawWorld(const SceneModel& model, std::uint32_t trial = 0) {
  RandomStream rng({1, 0, trial, 1});
  return model.DrawWorld(StillView(), rng);
}

// The first `n` candidates on a part that lie before camera 1, in its frame; fewer if they are rarer than one
// in a thousand.
inline std::vector<Eigen::Vector3d> Candidates(const World& world, size_t part, size_t n,
                                               std::uint32_t trial = 0) {
  RandomStream rng({1, 0, trial, 2});
  std::vector<Eigen::Vector3d> points;
  PointBlock block;
  for (size_t num_before = 0; num_before < 1000 * n && points.size() < n; num_before += PointBlock::kSize) {
    world.DrawCandidates(part, num_before, rng, &block);
    for (size_t i = 0; i < PointBlock::kSize && points.size() < n; ++i) {
      if (block.z_m[i] > 0.0) points.emplace_back(block.x_m[i], block.y_m[i], block.z_m[i]);
    }
  }
  return points;
}

// By which coordinate (0, 1, 2) an algorithm orders points.
inline auto Coordinate(int k) {
  return [k](const Eigen::Vector3d& point) { return point(k); };
}

// Points in the images of StillView(), as fractions of width and height from the upper left.
inline std::vector<double> ImageX(const std::vector<Eigen::Vector3d>& points_in_cam1) {
  std::vector<double> x;
  for (const Eigen::Vector3d& point : points_in_cam1)
    x.push_back(point.x() / point.z() * 700.0 / 640.0 + 0.5);
  return x;
}
inline std::vector<double> ImageY(const std::vector<Eigen::Vector3d>& points_in_cam1) {
  std::vector<double> y;
  for (const Eigen::Vector3d& point : points_in_cam1)
    y.push_back(point.y() / point.z() * 700.0 / 480.0 + 0.5);
  return y;
}
inline std::vector<double> Depths(const std::vector<Eigen::Vector3d>& points_in_cam1) {
  std::vector<double> depths_m;
  for (const Eigen::Vector3d& point : points_in_cam1) depths_m.push_back(point.z());
  return depths_m;
}

// Kolmogorov-Smirnov: the p-value of a sample under the uniform law on [low, high]; 0 if a number lies
// outside (by more than rounding), which is impossible under that law.
inline double UniformPValue(const std::vector<double>& sample, double low = 0.0, double high = 1.0) {
  const double rounding = 1e-9 * (high - low);
  if (std::ranges::min(sample) < low - rounding || std::ranges::max(sample) > high + rounding) return 0.0;
  return TestKolmogorovSmirnov(sample,
                               [&](double x) { return std::clamp((x - low) / (high - low), 0.0, 1.0); })
      .p_value;
}

// The plane {X : normal' X = distance} of least squares; the unit normal has z >= 0.
struct FittedPlane {
  Eigen::Vector3d normal;
  double distance;
  double largest_residual;
};
inline FittedPlane FitPlane(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) mean += point / static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points) scatter += (point - mean) * (point - mean).transpose();
  FittedPlane plane;
  plane.normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0);
  if (plane.normal.z() < 0.0) plane.normal = -plane.normal;
  plane.distance = plane.normal.dot(mean);
  plane.largest_residual = 0.0;
  for (const Eigen::Vector3d& point : points) {
    plane.largest_residual =
        std::max(plane.largest_residual, std::abs(plane.normal.dot(point) - plane.distance));
  }
  return plane;
}

}  // namespace rcme
