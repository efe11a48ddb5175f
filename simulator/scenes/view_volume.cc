#include "simulator/scenes/view_volume.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "parameters/input_error.h"

namespace rcme {

void DepthRange::Check() const {
  if (min_depth_m <= max_depth_m) return;
  throw InputError(
      fmt::format("min_depth_m: {} is not allowed; give at most max_depth_m = {}", min_depth_m, max_depth_m));
}

std::vector<Parameter> Parameters(DepthRange& depths) {
  return {
      Parameter::Real("min_depth_m", &depths.min_depth_m, {1e-6, 1e9}, "m", "least depth in camera 1"),
      Parameter::Real("max_depth_m", &depths.max_depth_m, {1e-6, 1e9}, "m", "greatest depth in camera 1")};
}

Eigen::Vector3d DrawRay(const SceneCamera& camera, RandomStream& rng) {
  constexpr int kMaxDraws = 10'000;
  for (int draw = 0; draw < kMaxDraws; ++draw) {
    const double y_px = -0.5 + camera.height * rng.Uniform();
    const double x_px = -0.5 + camera.width * rng.Uniform();
    const Eigen::Vector3d ray = camera.Ray({x_px, y_px});
    if (!std::isnan(ray.x())) return ray;
  }
  throw InputError(
      fmt::format("cameras: of {} x {} px the lens shows next to nothing; give another focal_px, image size "
                  "or coefficients of the lens",
                  camera.width, camera.height));
}

void DrawRays(const SceneCamera& camera, RandomStream& rng, RayBlock* rays) {
  if (camera.HasLens()) {
    for (size_t i = 0; i < PointBlock::kSize; ++i) {
      const Eigen::Vector3d ray = DrawRay(camera, rng);
      rays->x[i] = ray.x();
      rays->y[i] = ray.y();
    }
    return;
  }
  std::array<double, 2 * PointBlock::kSize> uniforms;
  rng.FillUniform(uniforms);
  const double cx = camera.cx, cy = camera.cy, fx = camera.fx, fy = camera.fy;
  const double width_px = camera.width, height_px = camera.height;
  for (size_t i = 0; i < PointBlock::kSize; ++i) {
    rays->x[i] = (-0.5 + width_px * uniforms[2 * i + 1] - cx) / fx;
    rays->y[i] = (-0.5 + height_px * uniforms[2 * i] - cy) / fy;
  }
}

void SetOnRays(const RayBlock& rays, const RayBlock::Numbers& depths_m, PointBlock* block) {
  const Eigen::Vector3d unseen = UnseenPoint();
  for (size_t i = 0; i < PointBlock::kSize; ++i) {
    const double depth_m = depths_m[i], x_m = depth_m * rays.x[i], y_m = depth_m * rays.y[i];
    const bool is_finite = depth_m < std::numeric_limits<double>::infinity();
    block->x_m[i] = is_finite ? x_m : unseen.x();
    block->y_m[i] = is_finite ? y_m : unseen.y();
    block->z_m[i] = is_finite ? depth_m : unseen.z();
  }
}

namespace {

void DrawBehindLens(const SceneCamera& camera1, const DepthRange& depths, RandomStream& rng,
                    PointBlock* block) {
  for (size_t i = 0; i < PointBlock::kSize; ++i) {
    const double y_px = -0.5 + camera1.height * rng.Uniform();
    const double x_px = -0.5 + camera1.width * rng.Uniform();
    const Eigen::Vector3d point = depths.Draw(rng) * camera1.Ray({x_px, y_px});
    block->Set(i, std::isnan(point.x()) ? UnseenPoint() : point);
  }
}

}  // namespace

// Three uniforms per point: its y in image 1, x in image 1, depth. The plain loop over arrays is vectorised
// by the compiler.
void DrawInViewVolume(const SceneCamera& camera1, const DepthRange& depths, RandomStream& rng,
                      PointBlock* block) {
  if (camera1.HasLens()) return DrawBehindLens(camera1, depths, rng, block);
  std::array<double, 3 * PointBlock::kSize> uniforms;
  rng.FillUniform(uniforms);
  const Camera camera = camera1;  // a copy, so that the block cannot alias it
  const double width_px = camera.width, height_px = camera.height;
  const double min_depth_m = depths.min_depth_m, depth_span_m = depths.max_depth_m - depths.min_depth_m;
  for (size_t i = 0; i < PointBlock::kSize; ++i) {
    const double depth_m = min_depth_m + depth_span_m * uniforms[3 * i + 2];
    block->x_m[i] = depth_m * ((-0.5 + width_px * uniforms[3 * i + 1] - camera.cx) / camera.fx);
    block->y_m[i] = depth_m * ((-0.5 + height_px * uniforms[3 * i] - camera.cy) / camera.fy);
    block->z_m[i] = depth_m;
  }
}

}  // namespace rcme
