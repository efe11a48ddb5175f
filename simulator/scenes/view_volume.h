// The part of space that image 1 shows between two depths, for points that lie on no surface.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "parameters/parameter.h"
#include "simulator/scene_camera.h"
#include "simulator/scene_model.h"
#include "stats/random.h"

namespace rcme {

// Depths in camera 1.
struct DepthRange {
  double min_depth_m = 2.0, max_depth_m = 8.0;

  double Middle() const { return 0.5 * (min_depth_m + max_depth_m); }
  double Draw(RandomStream& rng) const { return rng.Uniform(min_depth_m, max_depth_m); }
  // Throws InputError that names both keys if there is no depth between them.
  void Check() const;
};
std::vector<Parameter> Parameters(DepthRange& depths);

// The viewing ray (third component 1) of a pixel uniform over the image; draws two uniforms, y first. With a
// lens: uniform over the pixels that a ray reaches; throws InputError if these are less than about 0.1 % of
// the image.
Eigen::Vector3d DrawRay(const SceneCamera& camera, RandomStream& rng);
Eigen::Vector3d DrawRay(const Camera& without_its_lens, RandomStream& rng) = delete;

// Viewing rays (x, y, 1), as arrays.
struct RayBlock {
  using Numbers = std::array<double, PointBlock::kSize>;  // one of each ray
  Numbers x, y;
};

// Bit-identical to as many calls of DrawRay.
void DrawRays(const SceneCamera& camera, RandomStream& rng, RayBlock* rays);
void DrawRays(const Camera& without_its_lens, RandomStream& rng, RayBlock* rays) = delete;

// The points at these depths on the rays; UnseenPoint() where the depth is infinite.
void SetOnRays(const RayBlock& rays, const RayBlock::Numbers& depths_m, PointBlock* block);

// Points uniform over image 1 and uniform in depth within the range; UnseenPoint() at a pixel that no ray
// reaches.
void DrawInViewVolume(const SceneCamera& camera1, const DepthRange& depths, RandomStream& rng,
                      PointBlock* block);
void DrawInViewVolume(const Camera& without_its_lens, const DepthRange& depths, RandomStream& rng,
                      PointBlock* block) = delete;

}  // namespace rcme
