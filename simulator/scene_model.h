// A family of scenes: the interface of the files in simulator/scenes.
//
// A trial first draws the motion and then a world, which fixes this trial's clusters, planes or walls. It
// then draws points of that world, block after block, until enough of them are seen in both images. A world
// may have several parts; each gets its exact share of the points.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "parameters/parameter.h"
#include "simulator/view_pair.h"
#include "stats/random.h"

namespace rcme {

// Candidate points in camera 1's frame (m), as arrays for fast visibility tests.
struct PointBlock {
  static constexpr size_t kSize = 128;
  std::array<double, kSize> x_m, y_m, z_m;

  void Set(size_t i, const Eigen::Vector3d& point_in_cam1) {
    x_m[i] = point_in_cam1.x();
    y_m[i] = point_in_cam1.y();
    z_m[i] = point_in_cam1.z();
  }
};

// A candidate that no image shows, for draws that hit nothing: it lies behind camera 1.
inline Eigen::Vector3d UnseenPoint() { return {0.0, 0.0, -1.0}; }

// One world, drawn for one trial.
class World {
 public:
  virtual ~World() = default;
  // The share of the points in each part of the world; they sum to 1.
  virtual std::vector<double> PartShares() const { return {1.0}; }
  // Fills the block with candidates on a part; `num_before` of its candidates were drawn before. They may lie
  // behind a camera or outside its image: only those that both cameras see are kept. Candidates are
  // independent or, on a part with finitely many points, all different.
  virtual void DrawCandidates(size_t part, size_t num_before, RandomStream& rng, PointBlock* block) const = 0;
  // See Scene::repeat_steps_m.
  virtual std::vector<Eigen::Vector3d> RepeatSteps() const { return {}; }
};

// For worlds that draw their candidates one by one.
class PointwiseWorld : public World {
 public:
  void DrawCandidates(size_t part, size_t, RandomStream& rng, PointBlock* block) const final {
    for (size_t i = 0; i < PointBlock::kSize; ++i) block->Set(i, DrawCandidate(part, rng));
  }

 protected:
  virtual Eigen::Vector3d DrawCandidate(size_t part, RandomStream& rng) const = 0;
};

// A family of worlds with its parameters. Configured once, then const and shared by threads.
class SceneModel {
 public:
  virtual ~SceneModel() = default;
  // The parameters by name; valid as long as the model lives.
  virtual std::vector<Parameter> Parameters() = 0;
  // Throws InputError that names the keys if the parameters contradict each other or admit no world in view.
  virtual std::unique_ptr<const World> DrawWorld(const ViewPair& view, RandomStream& rng) const = 0;
};

}  // namespace rcme
