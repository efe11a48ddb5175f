#include <fmt/format.h>

#include <span>

#include "parameters/input_error.h"
#include "simulator/scenes/scenes.h"

namespace rcme {
namespace {

constexpr double kMaxSites = 1e6;

struct LatticeShape {
  int num_columns = 30, num_rows = 20, num_motif_points = 8;
  double depth_m = 10.0, step_m = 0.5, relief_m = 0.2;

  double NumSites() const { return static_cast<double>(num_columns) * num_rows * num_motif_points; }
};

// The sites in random order, each a candidate once; then UnseenPoint().
class LatticeWorld : public World {
 public:
  LatticeWorld(std::vector<Eigen::Vector3d> sites_in_cam1, std::vector<Eigen::Vector3d> repeat_steps_m)
      : sites_in_cam1_(std::move(sites_in_cam1)), repeat_steps_m_(std::move(repeat_steps_m)) {}

  void DrawCandidates(size_t, size_t num_before, RandomStream&, PointBlock* block) const override {
    for (size_t i = 0; i < PointBlock::kSize; ++i) {
      const size_t site = num_before + i;
      block->Set(i, site < sites_in_cam1_.size() ? sites_in_cam1_[site] : UnseenPoint());
    }
  }
  std::vector<Eigen::Vector3d> RepeatSteps() const override { return repeat_steps_m_; }

 private:
  std::vector<Eigen::Vector3d> sites_in_cam1_, repeat_steps_m_;
};

// A facade that faces the camera and repeats itself: the same random motif, in all three coordinates, in
// every cell of a lattice. A step of the lattice maps the facade onto itself. Points are drawn from the sites
// (cell, point of the motif) that both images show, without repetition, each set equally likely. A study that
// asks for more matches than such sites gets an InputError.
class Lattice : public SceneModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {
        Parameter::Integer("lattice_columns", &shape_.num_columns, {1, 10'000}, "cells from left to right"),
        Parameter::Integer("lattice_rows", &shape_.num_rows, {1, 10'000}, "cells from top to bottom"),
        Parameter::Real("lattice_step_m", &shape_.step_m, {1e-9, 1e6}, "m", "side of a square cell"),
        Parameter::Real("lattice_depth_m", &shape_.depth_m, {1e-6, 1e9}, "m",
                        "depth of the facade, its middle within half a cell of the optical axis"),
        Parameter::Integer("motif_points", &shape_.num_motif_points, {1, 10'000},
                           "uniform in the cell, new in each trial"),
        Parameter::Real("relief_m", &shape_.relief_m, {0.0, 1e6}, "m",
                        "greatest distance from the facade's plane, uniform to either side")};
  }

  std::unique_ptr<const World> DrawWorld(const ViewPair& view, RandomStream& rng) const override {
    Check();
    const std::vector<Eigen::Vector3d> motif = DrawMotif(rng);
    std::vector<Eigen::Vector3d> sites_in_cam1;
    for (int row = 0; row < shape_.num_rows; ++row) {
      for (int column = 0; column < shape_.num_columns; ++column) {
        const Eigen::Vector3d cell_m(column * shape_.step_m, row * shape_.step_m, 0.0);
        for (const Eigen::Vector3d& point : motif) {
          if (view.Sees(point + cell_m)) sites_in_cam1.push_back(point + cell_m);
        }
      }
    }
    rng.Shuffle(std::span(sites_in_cam1));
    return std::make_unique<LatticeWorld>(std::move(sites_in_cam1), RepeatSteps());
  }

 private:
  void Check() const {
    if (shape_.relief_m >= shape_.depth_m) {
      throw InputError(fmt::format("relief_m: {} is not allowed; give less than lattice_depth_m = {}",
                                   shape_.relief_m, shape_.depth_m));
    }
    if (shape_.NumSites() > kMaxSites) {
      throw InputError(fmt::format(
          "lattice_columns, lattice_rows, motif_points: {} x {} x {} is not allowed; give at most {} points",
          shape_.num_columns, shape_.num_rows, shape_.num_motif_points, kMaxSites));
    }
  }

  // The motif in the first cell (camera 1's frame). The middle of the lattice is within half a cell of the
  // optical axis.
  std::vector<Eigen::Vector3d> DrawMotif(RandomStream& rng) const {
    const double step_m = shape_.step_m;
    const double left_m = step_m * (rng.Uniform(-0.5, 0.5) - 0.5 * shape_.num_columns);
    const double top_m = step_m * (rng.Uniform(-0.5, 0.5) - 0.5 * shape_.num_rows);
    std::vector<Eigen::Vector3d> motif;
    for (int k = 0; k < shape_.num_motif_points; ++k) {
      const double x_m = left_m + step_m * rng.Uniform(), y_m = top_m + step_m * rng.Uniform();
      motif.emplace_back(x_m, y_m, shape_.depth_m + rng.Uniform(-shape_.relief_m, shape_.relief_m));
    }
    return motif;
  }

  std::vector<Eigen::Vector3d> RepeatSteps() const {
    std::vector<Eigen::Vector3d> steps_m;
    if (shape_.num_columns > 1) steps_m.emplace_back(shape_.step_m, 0.0, 0.0);
    if (shape_.num_rows > 1) steps_m.emplace_back(0.0, shape_.step_m, 0.0);
    return steps_m;
  }

  LatticeShape shape_;
};

}  // namespace

std::unique_ptr<SceneModel> MakeLattice() { return std::make_unique<Lattice>(); }

}  // namespace rcme
