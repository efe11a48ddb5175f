#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>

#include "parameters/input_error.h"
#include "simulator/noise/noise_laws.h"
#include "stats/portable_math.h"
#include "stats/student_scales.h"

namespace rcme {
namespace {

// A mosaic over one image: a square lattice, turned by a uniform angle and shifted uniformly, with
// independent standard normals (x and y) in each cell. With cells of side s, two points at distance d, u = d
// / s <= 1, lie in one cell with probability
//
//   E_angle (1 - u |cos|)(1 - u |sin|) = 1 - 4 u / pi + u^2 / pi,
//
// which is the correlation of their normals. It is 0 from u = sqrt(2) on.
class Mosaic {
 public:
  Mosaic(double side_px, RandomStream& rng) : side_px_(side_px), turn_(PortableCosSinOfTurn(rng.Uniform())) {
    shift_.x() = rng.Uniform();
    shift_.y() = rng.Uniform();
  }

  const Eigen::Vector2d& At(const Eigen::Vector2d& x_px, RandomStream& rng) {
    const Eigen::Vector2d turned(turn_.cos * x_px.x() + turn_.sin * x_px.y(),
                                 turn_.cos * x_px.y() - turn_.sin * x_px.x());
    const Eigen::Vector2d cell = (turned / side_px_ + shift_).array().floor();
    const auto [found, is_new] = normals_.try_emplace({cell.x(), cell.y()});
    if (is_new) {
      found->second.x() = rng.Normal();
      found->second.y() = rng.Normal();
    }
    return found->second;
  }

 private:
  double side_px_;
  CosSin turn_;
  Eigen::Vector2d shift_;
  std::map<std::pair<double, double>, Eigen::Vector2d> normals_;  // by cell
};

// Normal and correlated between neighbours, like key points on the same piece of texture. A share rho of the
// variance comes from a mosaic over each image, the rest is independent for each point. The errors of two
// points in one image at distance d have the correlation rho (1 - 4 u / pi + u^2 / pi), u = d /
// noise_correlation_length_px <= 1. With Student's scales all four errors of a match are large together, like
// those of a large key point.
class CorrelatedNoise : public NoiseModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {SigmaParameter(&sigma_px_),
            Parameter::Real("noise_correlation", &correlation_, {0.0, 1.0}, "",
                            "correlation of errors at one place of an image"),
            Parameter::Real("noise_correlation_length_px", &length_px_, {0.01, 1e5}, "px",
                            "distance at which it is 0.045 of that; 0 beyond 1.41 times"),
            Parameter::Real(
                "noise_student_dof", &student_dof_, {0.0, 1000.0}, "",
                "degrees of freedom of Student's t in 32 steps, common to a match's errors; 0: normal")};
  }

  void AddTo(std::span<Correspondence> matches, RandomStream& rng) const override {
    Mosaic in_image1(length_px_, rng), in_image2(length_px_, rng);
    const double shared_px = sigma_px_ * std::sqrt(correlation_),
                 own_px = sigma_px_ * std::sqrt(1.0 - correlation_);
    if (student_dof_ > 0.0 && student_dof_ < 0.1)  // the greatest step would be infinite
      throw InputError(
          fmt::format("noise_student_dof: {} is not allowed; give 0, or 0.1 to 1000", student_dof_));
    const StudentScales scales(student_dof_);
    for (Correspondence& match : matches) {
      const double scale = scales.Draw(rng);
      const auto error = [&](const Eigen::Vector2d& of_neighbours) {
        const double x = rng.Normal(), y = rng.Normal();
        return Eigen::Vector2d(scale * (shared_px * of_neighbours + own_px * Eigen::Vector2d(x, y)));
      };
      match.x1_px += error(in_image1.At(match.x1_px, rng));
      match.x2_px += error(in_image2.At(match.x2_px, rng));
    }
  }

 private:
  double correlation_ = 0.5, length_px_ = 20.0;
  double student_dof_ = 0.0;
};

}  // namespace

std::unique_ptr<NoiseModel> MakeCorrelatedNoise() { return std::make_unique<CorrelatedNoise>(); }

}  // namespace rcme
