// Divides the variance of residuals into the part of each match alone, the part shared by the matches of one
// key point, and the part shared by neighbours, and computes the covariance of a least-squares motion from
// them.
//
// The errors of key points are isotropic in each image. The correlation of two errors at a distance d is a
// mixture of exponentials, which is a covariance function for all weights v_k >= 0. Then the residuals
// r = g / (sigma |J|) of two matches i, j have the covariance
//
//   V_ij = v_0 [i = j] + v_1 [same key point] + sum_k v_k c_ij(l_k),   l = 30, 90, 270 px
//   c_ij(l) = u_i1' u_j1 exp(-d_ij1 / l) + u_i2' u_j2 exp(-d_ij2 / l)
//
// Here u_i = J' / |J| (4x1). Its two halves, one per image, are normals of the epipolar lines, and c_ii = 1.
// All matches of a key point are placed where its first match is. With the residuals' derivatives J_i (1x5)
// along the motion and A = sum J_i' J_i, the motion has the covariance A^-1 (sum_ij V_ij J_i' J_j) A^-1, a
// sandwich with an estimated kernel (Conley 1999: with a given one).
//
// The v are fitted by the method of moments (Haseman and Elston 1972): least squares of q - T v with
//
//   q_0 = sum over key points of the mean r_i^2
//   q_1 = sum over key points of the mean r_i r_j, i != j
//   q_k = sum over pairs of key points g, h of c_gh(l_k) times the product of their mean residuals
//
// Each q_a is a quadratic form r' W_a r, so that T_ab = tr(W_a P K_b P). P = I - U U' with U = J A^-1/2
// projects out the five parameters that were fitted; K_b is the matrix that v_b multiplies. A key point
// counts once, however often it is matched; otherwise one that is matched fifty times would decide alone. The
// weights are M_ab = tr(W_a W_b), the covariance of q / sqrt(2) for independent residuals. The constraint
// v >= 0 is met by the best of all subsets of the parts.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "estimator/robust_covariance/clustered_covariance.h"

namespace rcme {

struct ResidualVariances {
  double own = 1.0;                    // v_0
  double of_key_point = 0.0;           // v_1
  std::vector<double> of_neighbours;   // v_k, one per length
  double deviance = 0.0;               // improvement over v_0 alone
  Matrix5d shared = Matrix5d::Zero();  // A^-1 (sum_ij (V_ij - v_0 [i = j]) J_i' J_j) A^-1

  double Sum() const;
};

// Fits the variances. `groups` holds the key point of each match (KeyPointGroups). All variance is `own`
// unless shared parts improve the deviance by more than 1. A part without a pair of matches is zero. If there
// are more than 1,500 key points, 1,500 of them represent all.
ResidualVariances FitResidualVariances(const MatchScores& scores, std::span<const int> groups);

inline constexpr double kKeyPointRadiusPx = 1.0;  // matches within it share a key point
inline constexpr std::array<double, 3> kNeighbourLengthsPx = {30.0, 90.0, 270.0};
inline constexpr int kNumVarianceParts = 5;  // own, key point, neighbours (one per length)

// The equations of the moments, q = T v with weights M, and the contribution of each v to the middle of the
// sandwich. For several motions together, add up q, T and M (camera_noise/shared_variance.h).
struct ResidualMoments {
  using Parts = Eigen::Matrix<double, kNumVarianceParts, 1>;
  using PartsSquare = Eigen::Matrix<double, kNumVarianceParts, kNumVarianceParts>;
  Parts q = Parts::Zero();
  PartsSquare T = PartsSquare::Zero(), M = PartsSquare::Zero();
  std::array<Matrix5d, kNumVarianceParts> G;  // U' K_b U
};
// Nullopt if the matches do not determine the motion. The lengths are kNeighbourLengthsPx times `unit_px`.
std::optional<ResidualMoments> ComputeResidualMoments(const MatchScores& scores, std::span<const int> groups,
                                                      double unit_px = 1.0);

// Known variances, relative to sigma^2, with a single length for neighbours.
struct KnownVariances {
  double own = 1.0, of_key_point = 0.0, of_neighbours = 0.0;
  double length_px = kNeighbourLengthsPx.back();
};
// The result of a fit, but with these variances instead of those of the residuals.
ResidualVariances TakeResidualVariances(const MatchScores& scores, std::span<const int> groups,
                                        const KnownVariances& known);

}  // namespace rcme
