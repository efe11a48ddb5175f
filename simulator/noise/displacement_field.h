// A smooth random field of displacements over one image.
#pragma once

#include <Eigen/Core>
#include <array>

#include "stats/random.h"

namespace rcme {

// A random field of variance 1 whose x and y components each have covariance exp(-d / reach). It is a sum of
// waves
//
//   f(x) = K^-1/2 sum_k a_k cos(w_k' x) + b_k sin(w_k' x),  a_k, b_k standard normal.
//
// Given the w its covariance is 1 / K sum cos(w_k' (x - y)), whose mean over w is the characteristic function
// of the law of w at x - y (Bochner; Rahimi and Recht 2007). exp(-|d| / reach) is that of Cauchy's law in two
// dimensions, w = (z_1, z_2) / (|z_0| reach) with standard normals z: Student's t with one degree of freedom.
class DisplacementField {
 public:
  DisplacementField(double reach_px, RandomStream& rng);

  Eigen::Vector2d At(const Eigen::Vector2d& x_px) const;

 private:
  static constexpr int kNumWaves = 64;
  struct Wave {
    Eigen::Vector2d turns_per_px, cosine, sine;
  };
  std::array<Wave, kNumWaves> waves_;
};

}  // namespace rcme
