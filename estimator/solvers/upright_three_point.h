#pragma once

#include <Eigen/Core>
#include <array>

namespace rcme {

// All essential matrices through three correspondences of calibrated rays, if the direction of gravity is
// known in both cameras. Gravity fixes two of the five degrees of freedom of the motion; each match is an
// equation for the other three, with up to four real solutions (Fraundorfer, Tanskanen & Pollefeys 2010).
//
// Derivation. The rotations A1 and A2 turn gravity to the y axis: A1 g1 = A2 g2 = (0, 1, 0). In the turned
// rays a = A1 x1 and b = A2 x2 the rotation is about the y axis, by an unknown angle theta:
//
//   R = A2' Ry(theta) A1,   t = A2' s,   E = A2' [s]x Ry(theta) A1,
//   x2' E x1 = s' n(theta),   n(theta) = (Ry(theta) a) x b.
//
// Three matches have a common s other than zero if and only if det [n_1 n_2 n_3] = 0, which is an equation
// for theta. Its degree shows in the coordinates
//
//   v = (n_z, n_x) = Rot(theta) w + h,   w = b_y (a_x, -a_z),   h = a_y (-b_x, b_z),
//   n_y = g cos theta + l sin theta,     g = a_z b_x - a_x b_z,   l = -(a_x b_x + a_z b_z),
//
// with Rot(theta) the rotation of the plane. As Rot(theta) w_i x Rot(theta) w_j = w_i x w_j, the cross
// product of two of the v is of first degree in cos theta and sin theta:
//
//   v_i x v_j = (w_i x w_j + h_i x h_j) + (w_i x h_j - w_j x h_i) cos theta - (w_i . h_j - w_j . h_i) sin
//   theta.
//
// So the determinant, the sum of n_y,k (v_i x v_j) over cyclic (i, j, k), is of second degree:
//
//   f(theta) = f_0 + f_1 cos theta + f_2 sin theta + f_3 cos 2 theta + f_4 sin 2 theta.
//
// With q = tan(theta / 2), (1 + q^2)^2 f is a quartic in q. Its root at infinity, theta = pi, is no special
// case: theta is counted from the one of five equally spaced angles that is opposite to the greatest |f|. As
// f has five coefficients, it cannot vanish at all five.
class UprightThreePoint {
 public:
  static constexpr int kSampleSize = 3;
  static constexpr int kMaxModels = 4;
  using Rays = std::array<Eigen::Vector3d, kSampleSize>;

  // The direction of gravity in each camera's frame: unit vectors g1 and g2, g2 = R g1.
  UprightThreePoint(const Eigen::Vector3d& gravity1, const Eigen::Vector3d& gravity2);

  // E[0] ... E[count - 1] with x2' E x1 = 0 in rays and Frobenius norm sqrt(2); the sign is arbitrary.
  // Ascending in tan(theta / 2), theta counted as above.
  struct Solutions {
    std::array<Eigen::Matrix3d, kMaxModels> E;
    int count = 0;
  };

  // No solution if a number is not finite, or if every theta is one, as for a repeated match (f vanishes to
  // 1e-9 of its terms). A solution without a direction of translation is left out: that of a pure rotation,
  // where n_1, n_2 and n_3 are parallel to 1e-9. Two solutions that nearly coincide may be missed. Lengths of
  // rays do not matter. Allocates nothing.
  Solutions Solve(const Rays& rays1, const Rays& rays2) const;

 private:
  Eigen::Matrix3d upright1_, upright2_;  // A1, A2
};

}  // namespace rcme
